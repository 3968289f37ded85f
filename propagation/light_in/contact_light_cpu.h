#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "core/visibility/embree_scene.h"
#include "voxel/voxel_grid.h"

namespace volgi {

/// A visible point that something bright is close to, as seen along `way`.
struct ContactPoint {
  glm::vec3 position, normal;  // world; the normal on the viewer's side, unit
  glm::vec3 way{0.0f};         // unit, the way the viewer's ray came
  float distance_m = 0.0f;     // that it came
  std::uint32_t seed = 0;      // another for each point
};

/// Of one part of what reaches a point: its mean over paths [W m^-2], and the variance of that, over red, green, blue.
struct ContactPart {
  glm::vec3 irradiance{0.0f};
  float variance = 0.0f;
};
struct ContactLight {
  ContactPart near, far;  // by what the paths' first rays meet; both after one reflection or more
};

/// What is known of sides, by side.
struct ContactSides {
  std::span<const glm::vec3> radiosity;  // of all light but what lamps bring straight and what is emitted [W m^-2]
  std::span<const glm::vec3> from_far;   // what they receive from sides that are not near, emitted or sent on [W m^-2]
};

/// Indirect light where surfaces are closer to each other than cells are large, as in a slot over a lamp or at the foot
/// of a step beside a sunlit spot: neither sides, which are means over cells, nor virtual lights, which stand for more
/// than that, know how light goes to and fro there. Paths do (a final gather whose rays end at once is carried on:
/// Jensen 2001, "Realistic Image Synthesis Using Photon Mapping", 9.3; docs/theory.md#contacts): from each point by the
/// cosine, at what they meet they take the lamps' light by a shadow ray. As long as what they meet is within NEAR_CELLS
/// they take what the side there receives from farther ones, and go on; the first rays that meet what is far take what
/// the side there sends. No path has to find a lamp's spot elsewhere, which is what makes paths noisy.
/// Cost: some 1 us for each path.
std::vector<ContactLight> contact_light(const VoxelGrid& voxels, const EmbreeScene& embree, const ContactSides& sides,
                                        std::span<const ContactPoint> points, int paths);
inline constexpr int NEAR_CELLS = 2;

/// What lamps bring straight and a surface sends on, of one lamp chosen by what each would bring with nothing between:
/// right in the mean over seeds [W m^-2]. @param origin  from where the point sees what it sees. Thread-safe.
glm::vec3 radiosity_by_lamps(const EmbreeScene& embree, glm::vec3 origin, glm::vec3 normal, glm::vec3 albedo,
                             std::uint32_t seed);

}  // namespace volgi
