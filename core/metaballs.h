#pragma once
#include <array>
#include <glm/glm.hpp>

#include "core/scene.h"

namespace volgi {

/// Eight soft balls that move, meet and part in a room: the field sum over balls of (1 - r^2/R^2)^3 inside each ball's
/// radius R, less a threshold. Twice differentiable; zero beyond R, so that a ball costs only where it is.
/// Source: Wyvill, McPheeters and Wyvill 1986, "Data structure for soft objects" (their polynomial's simpler sibling);
/// the scene is after Dong et al. 2009, whose metaballs have 5 k triangles.
class Metaballs {
 public:
  static constexpr int kCount = 8;
  static constexpr double kPeriod_s = 8.0;  // after which all balls are where they were, moving as they did

  /// The balls at a time, in the room's centred frame [m]: |centre| + radius stays below 1 m on every axis.
  explicit Metaballs(double time_s);

  /// Above zero inside.
  float value(glm::vec3 position) const;
  /// Unit, towards lower values; +Y where the field is flat (where two balls just touch).
  glm::vec3 outward_normal(glm::vec3 position) const;

  struct Ball {
    glm::vec3 centre;
    float radius_m;  // of influence; a ball alone has a surface at 0.61 of it
  };
  const std::array<Ball, kCount>& balls() const { return balls_; }

 private:
  std::array<Ball, kCount> balls_;
};

/// The scene `builtin:metaballs` at any time: the Cornell box's shell (2 m, open towards +Z) with its spot light and
/// camera, and in it the metaballs: about 5000 triangles, closed, front outwards, smooth normals, as many components as
/// there happen to be. Deterministic. Cost: about 2 ms on one core.
Scene metaballs_scene(double time_s);
/// Moves a scene that metaballs_scene made to another time; the room stays.
void move_metaballs(Scene& scene, double time_s);
/// Of the room, at any time.
WorldBox metaballs_bounds();

}  // namespace volgi
