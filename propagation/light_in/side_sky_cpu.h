#pragma once
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "core/sky.h"
#include "core/visibility/embree_scene.h"
#include "propagation/side_flux.h"
#include "voxel/voxel_grid.h"

namespace volgi {

/// Sky light on a volume's sides after a screen that carries its arrival: as long as neither sides nor parts change,
/// what was found is kept. Twin: screen/sources/sky/side_sky_gl.h, with the maps of pixels.
class SideSkyCpu {
 public:
  /// Irradiance of every side straight from the sky's parts [W m^-2], w = 0, each as far as a ray from the side's
  /// surface meets nothing. A side looks at every n-th part, n times as bright: neighbours look at others, and pixels
  /// take means over 3^3 cells. No result depends on the number of threads. Cost: kRays rays a side.
  /// @param version  of `parts`. @param sample  of pictures that are averaged: sides look at other parts.
  const std::vector<glm::vec4>& irradiance(const VoxelGrid& voxels, const EmbreeScene& embree,
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
void add_sky(const VoxelGrid& voxels, std::span<const glm::vec4> irradiance, bool apart, SideFlux& flux);

}  // namespace volgi
