#pragma once
#include <glm/glm.hpp>
#include <span>

#include "core/scene.h"

namespace volgi {

/// Share of rays from `from`, even over all directions, that leave the scene before they have met a third surface
/// (going on from the first two as diffuse light does): what is lost, or looks black, where no sky is around.
/// Deterministic. Cost: Embree's tree and at most 3 OPENNESS_RAYS rays.
double openness(const Scene& scene, std::span<const glm::vec3> from);
inline constexpr int OPENNESS_RAYS = 512;  // from each point
/// Less comes from cracks between triangles.
inline constexpr double LEAST_OPENNESS = 0.005;

/// Says once that the scene is open and has no sky, if it is: from where its camera stands and where its punctual
/// lights do (a sun has no place).
void warn_of_open_scene(const Scene& scene, glm::vec3 eye);

}  // namespace volgi
