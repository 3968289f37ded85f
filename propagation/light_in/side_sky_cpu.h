#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "core/sky.h"
#include "core/visibility/embree_scene.h"
#include "propagation/side_flux.h"
#include "voxel/volume_sides.h"

namespace volgi {

/// Which of every `stride` parts of the sky a side takes: 0 ... stride - 1. An additive recurrence over the cells
/// (Roberts 2018: powers of 1/1.2207..., in units of 2^-32) and the faces, so that sides beside each other take
/// different parts and their mean knows most of them, whatever order sides are in.
/// @param sample  of pictures that are averaged (core/sample_sequence.h): in `stride` of them a side takes each once.
inline int first_part_of_side(glm::ivec3 cell, int face, int stride, int sample = 0) {
  const std::uint32_t place = 3518319155u * std::uint32_t(cell.x) + 2882110345u * std::uint32_t(cell.y) +
                              2360945575u * std::uint32_t(cell.z) + 2654435769u * std::uint32_t(face);
  return int(((std::uint64_t(place) * std::uint64_t(stride) >> 32) + std::uint64_t(sample)) % std::uint64_t(stride));
}

/// Sky light on a volume's sides after a screen that carries its arrival: as long as neither sides nor parts change,
/// what was found is kept. Twin: screen/sources/sky/side_sky_gl.h, with the maps of pixels.
class SideSkyCpu {
 public:
  /// Irradiance of every side straight from the sky's parts [W m^-2], w = 0, each as far as a ray from the side's
  /// surface meets nothing. A side looks at every n-th part, n times as bright: neighbours look at others, and pixels
  /// take means over 3^3 cells. No result depends on the number of threads. Cost: kRays rays a side.
  /// @param version  of `parts`. @param sample  of pictures that are averaged: sides look at other parts.
  const std::vector<glm::vec4>& irradiance(const VolumeSides& sides, const EmbreeScene& embree,
                                           std::span<const SkyLight> parts, int version, int sample = 0);
  void scene_moved() { version_ = -1; }
  static constexpr int kRays = 64;

 private:
  int version_ = -1, sample_ = 0;
  std::vector<shared::Side> sides_;  // that irradiance_ is of
  std::vector<glm::vec4> irradiance_;
};

/// Adds what sides reflect of it to their flux. @param apart  where orders are counted: as emission, which has one
/// order more.
void add_sky(const VolumeSides& sides, std::span<const glm::vec4> irradiance, bool apart, SideFlux& flux);

}  // namespace volgi
