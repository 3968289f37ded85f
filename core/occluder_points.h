#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "core/scene.h"
#include "shaders/shared/occluder_point.shared.h"

namespace volgi {

/// Points on all surfaces, evenly by area, that stand for them where light is stopped (Ritschel et al. 2008, section
/// 4.1). They keep their places on their triangles while these move. Of the points any aligned run whose length is a
/// power of two is itself spread evenly: strata come in bit-reversed order. What alpha lets pass has points without
/// area, as large a share of them.
class OccluderPoints {
 public:
  /// @param count  a power of two. Cost: one look at each triangle, and at the textures of each point.
  OccluderPoints(const Scene& scene, int count);

  /// The scene has moved: places anew, unless it has other triangles; then other points. Cost: count positions.
  void follow(const Scene& scene);

  const std::vector<shared::OccluderPoint>& points() const { return points_; }

 private:
  struct Place {
    std::uint32_t mesh = 0, triangle = 0;
    float u = 0.0f, v = 0.0f;
    bool stops = false;
  };
  void choose(const Scene& scene);
  void place(const Scene& scene);

  int count_;
  size_t triangles_ = 0;
  double each_m2_ = 0.0;
  std::vector<Place> places_;
  std::vector<shared::OccluderPoint> points_;
};

}  // namespace volgi
