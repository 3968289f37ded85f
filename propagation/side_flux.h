#pragma once
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "core/light.h"
#include "voxel/side_halo.h"
#include "voxel/volume_sides.h"

namespace volgi {

/// What lit and emissive surfaces send before any transport, as flux A·B0 per side [W] (rgb): light in. Twin of
/// SideFluxGl.
struct SideFlux {
  std::vector<glm::vec4> emitted;   // emission: its first arrival is direct light
  std::vector<glm::vec4> punctual;  // reflected light of punctual sources
  glm::vec3 lost{0.0f};             // flux that found no side anywhere near [W]
  bool emits = false;               // `emitted` is light of an order of its own
};

/// Deposits samples on the sides that stand for their points (docs/theory.md#light-in): the sum over sides and `lost`
/// is the sum over samples. Samples are added in their order, whatever the number of threads.
/// Of a cascade each goes to the level of the cells that see it.
void deposit(const VolumeSides& sides, std::span<const FluxSample> samples, std::span<glm::vec4> flux, glm::vec3& lost);

/// All ranks: the same, of samples that are spread over them in any way, to the last bit: the rank that has a sample's
/// cell looks for its sides, and what belongs to others goes there; each side adds up in the order of the numbers.
/// @param lost  of all ranks.
void deposit(const VoxelGrid& voxels, const RanksOfVolume& ranks, std::span<const NumberedFluxSample> samples,
             std::span<glm::vec4> flux, glm::vec3& lost);

}  // namespace volgi
