#pragma once
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "screen/base/reflective_shadow_map.h"
#include "screen/frame/light_path.h"
#include "screen/frame/type_map.h"

namespace volgi::screen {

/// Where the volume is computed: on the GPU, or by its CPU twin (whose answer is uploaded). `automatic` takes the CPU
/// where GL is a software rasterizer, and the GPU elsewhere.
enum class Backend { automatic, gpu, cpu };
/// What `automatic` means with the current gl::Context.
bool runs_on_gpu(Backend backend);

/// What a picture is asked for. Options of techniques are structs of their leaves: of<VolumeOptions>().grid_cells = 64.
struct FrameOptions {
  std::string recipe;                // --gi; registry.h lists them; empty: default_recipe()
  std::vector<std::string> without;  // --without: stages of the recipe that are left out, by StageType::name
  LightPart light = LightPart::full;
  std::optional<int> bounces;  // reflections; 0: direct light alone; none: all of them
  glm::ivec2 size{512, 512};
  Backend backend = Backend::automatic;
  TypeMap settings;

  template <class T>
  T& of() {
    return settings.of<T>();
  }
  template <class T>
  const T& of() const {
    return settings.of<T>();
  }
};

}  // namespace volgi::screen
