#pragma once
#include <string>
#include <vector>

namespace volgi::screen {

/// What a virtual light gives a point, over its flux (shaders/screen/gather/subsplats/subsplat_light.glsl).
enum class LightForm {
  point,  // Nichols 2010, eq. 3.2, no nearer than the light is large
  disk,   // eq. 4.1
  exact,  // shared/disk_to_point.shared.h
};

inline std::vector<std::string> defines_of(LightForm form) {
  if (form == LightForm::disk) return {};
  return {form == LightForm::point ? "FORM_POINT" : "FORM_EXACT"};
}

}  // namespace volgi::screen
