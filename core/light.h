#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "core/scene.h"
#include "shaders/shared/light.shared.h"

namespace volgi {

/// The light as shaders and the path tracer evaluate it.
shared::PunctualLight to_shared(const Light& light);

/// A sample of light that leaves a surface: what the volume takes in. Plain data, so that lower rooms never ask where
/// light comes from (reflective shadow map texels, pieces of emitters, Embree rays).
struct FluxSample {
  glm::vec3 position;  // on the surface, centred frame
  glm::vec3 normal;    // unit, on the side that the light leaves
  glm::vec3 flux;      // power leaving [W]
};

/// One of many that are shared out: numbers give the order in which they count.
struct NumberedFluxSample {
  FluxSample sample;
  std::uint64_t number;
};

}  // namespace volgi
