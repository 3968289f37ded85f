#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "core/scene.h"
#include "core/visibility/embree_scene.h"

namespace volgi {

/// A point on an emissive triangle.
struct EmitterSample {
  TriangleIndex triangle;
  glm::vec3 position;
  glm::vec3 normal;    // unit, front side
  glm::vec3 radiance;  // sent to the front side, times alpha
  bool double_sided = false;
  float pdf_area = 0.0f;  // [1/m^2]; 0 when nothing was sampled
};

/// All emissive triangles of a scene, chosen with probability proportional to the power they send.
class Emitters {
 public:
  explicit Emitters(const Scene& scene);
  bool empty() const { return triangles_.empty(); }

  /// @param uv, choice  uniform in [0,1). Few triangles are chosen by uv.x, which is then stretched, so that stratified
  ///                    points stay stratified; `choice` is for many, where that would leave uv.x too few bits.
  EmitterSample sample(glm::vec2 uv, float choice) const;
  /// Density per area [1/m^2] with which sample() chooses points of this triangle; 0 when it does not emit.
  float pdf_area(TriangleIndex index) const;

 private:
  struct Entry {
    TriangleIndex index;
    float pdf_area;
  };
  const Scene* scene_;
  std::vector<Entry> triangles_;
  std::vector<double> cumulative_;            // of the probability, same size
  std::vector<std::vector<float>> pdf_area_;  // per mesh (empty when it does not emit) and triangle
};

}  // namespace volgi
