#pragma once
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "core/visibility/embree_scene.h"
#include "propagation/side_flux.h"
#include "shaders/shared/near_light.shared.h"
#include "shaders/shared/virtual_light.shared.h"
#include "voxel/voxel_grid.h"

namespace volgi {

/// Which of every `stride` virtual lights a side takes: 0 ... stride - 1. An additive recurrence over the cells
/// (Roberts 2018: powers of 1/1.2207..., in units of 2^-32) and the faces, so that sides beside each other take
/// different lights and their mean knows most of them, whatever order sides are in.
/// @param sample  of pictures that are averaged (core/sample_sequence.h): in `stride` of them a side takes each once.
inline int first_light_of_side(glm::ivec3 cell, int face, int stride, int sample = 0) {
  const std::uint32_t place = 3518319155u * std::uint32_t(cell.x) + 2882110345u * std::uint32_t(cell.y) +
                              2360945575u * std::uint32_t(cell.z) + 2654435769u * std::uint32_t(face);
  return int(((std::uint64_t(place) * std::uint64_t(stride) >> 32) + std::uint64_t(sample)) % std::uint64_t(stride));
}

/// The stride that keeps rays within a budget: what 1024 lights in strides of 16 cost 8192 sides, as cornell has in 32
/// cells. Few sides take more of the lights each, many sides every 32nd: neighbours even that out.
int automatic_stride(size_t sides, size_t lights);

/// Virtual lights on the host, as a volume's sides take them.
struct VirtualLightsForSides {
  std::vector<shared::VirtualLight> lights;  // reflected ones first
  int reflected = 0;
  /// Parts of each light, SUBLIGHTS_PER_LIGHT of them, that light what is near it; none: the lights do that themselves.
  std::vector<shared::SubLight> sublights;
  float near_zone = 0.0f;  // areas of a light (shared::far_share)
  int sample = 0;          // that they are of (core/sample_sequence.h)
};

/// Irradiance of every side from virtual lights [W m^-2], w = 0: the sum of Phi times shared::disk_to_point over those
/// that a ray from the side's surface reaches. A side takes every stride-th light, `stride` times as bright. Such a
/// light stands for stride A of surface, too, but a side cannot tell apart what is nearer together than it is large:
/// its own area is the most that is added, which takes the peaks off single sides. Where lights have sub-lights, a side
/// near one takes those instead, of every light and with rays of their own, by the share that pixels take them
/// (screen/gather/interleaved/near_lights.h). No result depends on the number of threads.
/// Cost: at most count / stride rays a side, and four for each light near it.
/// @param first, end  of `from.lights`. Where stride > 1, every stride-th should be an even choice, as lights along a
///   curve are; every 16th of Halton's sequence is a wedge.
/// Twin: screen/bounces/volume/side_gather_gl.h, with the maps of pixels.
std::vector<glm::vec4> side_gather(const VoxelGrid& voxels, const EmbreeScene& embree,
                                   const VirtualLightsForSides& from, size_t first, size_t end, int stride);

/// What sides reflect of it, A rho E [W] (docs/theory.md#light-in). E is that of the surface's plane, so A is the
/// side's own area, however it is tilted.
std::vector<glm::vec4> reflected_flux(const VoxelGrid& voxels, std::span<const glm::vec4> irradiance);

/// Light in of a volume after a first bounce by virtual lights. @param emission_apart  where orders are counted:
/// emission has one more, so what it brings goes in by itself; else all is `punctual`. @param stride  none:
/// automatic_stride().
SideFlux flux_after_first_bounce(const VoxelGrid& voxels, const EmbreeScene& embree, const VirtualLightsForSides& from,
                                 bool emission_apart, std::optional<int> stride = {});

}  // namespace volgi
