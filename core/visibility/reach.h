#pragma once
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "core/scene.h"

namespace volgi {

/// Corners of a box, in the scene's centred frame [m].
struct ReachedBox {
  glm::vec3 min;
  glm::vec3 max;
};

/// Where light can be that matters for a picture: around all that rays meet which start in `from` (the camera and the
/// lamps), even over all directions, and go on from surface to surface as diffuse light does. What one point in a
/// thousand lies beyond sends next to nothing, or was seen through a crack. Triangles that were met count whole, but
/// for what of them sticks out by more than a twentieth of the box (a ground plane that is a room's floor); so do
/// emissive ones, met or not. None: no ray met anything. Deterministic. Cost: Embree's tree and at most 6 REACH_RAYS
/// rays from each point.
std::optional<ReachedBox> reached_box(const Scene& scene, std::span<const glm::vec3> from);
inline constexpr int REACH_RAYS = 2048;

/// The camera's place and those of punctual lights, eight in all at most. A sun has none.
std::vector<glm::vec3> places_of_light(const Scene& scene, glm::vec3 eye);

}  // namespace volgi
