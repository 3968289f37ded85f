#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "core/scene.h"

namespace volgi {

/// A piece of surface, seen as a point from one of its sides.
struct SurfaceSample {
  glm::vec3 position;  // centred frame
  glm::vec3 normal;    // unit, geometric, on the side that is meant
  glm::vec3 albedo;    // times what of light the surface stops
  float area_m2;       // that the point stands for
};

/// `count` points spread evenly by area over both sides of all triangles of a scene, the same ones every time for a
/// `sample` of core/sample_sequence.h: strata of equal area, Halton points in each triangle. In an order in which those
/// that follow on each other face alike and lie near: by the axis that the normal is nearest to, then along Morton's
/// curve. Fewer, where the scene has no area. Cost: one look at each triangle.
std::vector<SurfaceSample> surface_points(const Scene& scene, int count, int sample = 0);

}  // namespace volgi
