#include "core/light.h"

#include <algorithm>
#include <cmath>

namespace volgi {

shared::PunctualLight to_shared(const Light& light) {
  shared::PunctualLight out{};
  out.position = light.position;
  out.direction = light.direction;
  out.intensity = light.intensity;
  out.range_m = light.type == Light::Type::directional ? 0.0f : light.range_m;
  switch (light.type) {
    case Light::Type::point:
      out.type = LIGHT_POINT;
      break;
    case Light::Type::spot: {
      out.type = LIGHT_SPOT;
      const float cos_inner = std::cos(light.inner_cone_rad);
      out.cos_outer = std::cos(light.outer_cone_rad);
      out.spot_scale = 1.0f / std::max(0.001f, cos_inner - out.cos_outer);
      out.outer_versine = 2.0f * std::pow(std::sin(0.5f * light.outer_cone_rad), 2.0f);
      out.spot_offset = -out.cos_outer * out.spot_scale;
      break;
    }
    case Light::Type::directional:
      out.type = LIGHT_DIRECTIONAL;
      break;
  }
  return out;
}

}  // namespace volgi
