#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "core/scene.h"

namespace volgi {

/// A piece of emissive surface, seen as a point.
struct EmitterPoint {
  glm::vec3 position;  // centred frame
  glm::vec3 normal;    // unit, geometric, on the side that the light leaves
  glm::vec3 flux;      // power leaving [W]
  float area_m2;       // of the surface that the point stands for; each side of a double-sided triangle counts
};

/// Evenly spread points on a scene's emissive triangles, as many to each as its power asks for.
class EmitterPoints {
 public:
  /// Cost: four looks at every texel of emissive textures on triangles, at most 128 x 128 a triangle.
  /// @param scene  must outlive this, and its meshes, materials and textures must stay.
  explicit EmitterPoints(const Scene& scene);

  bool empty() const { return sides_.empty(); }
  /// Power leaving all emissive surfaces [W]: pi times the integral of emitted radiance, times alpha.
  glm::dvec3 flux() const { return flux_; }
  /// `count` points, the same ones every time for a `sample` of core/sample_sequence.h: strata of equal power, Halton
  /// points in each triangle, in the order of Hilbert's curve there, so that points that follow on each other are a
  /// piece of surface. Without textures the luminance of their flux sums to that of flux() exactly, else as well as
  /// that many points sample a texture.
  std::vector<EmitterPoint> points(int count, int sample = 0) const;

 private:
  struct Side {
    std::uint32_t mesh, triangle;
    bool back;
    double area_m2;
  };
  const Scene* scene_;
  std::vector<Side> sides_;
  std::vector<double> cumulative_;  // share of the power of sides [0, i], the last is 1
  glm::dvec3 flux_{0.0};
};

}  // namespace volgi
