#pragma once
#include <glm/glm.hpp>
#include <span>

#include "propagation/bounces_cpu.h"
#include "voxel/volume_sides.h"

namespace volgi {

/// Of a visible point of a surface [W m^-2]; weight 0 where the volume has nothing to say.
struct PixelIrradiance {
  glm::vec3 direct{0.0f}, indirect{0.0f};
  float weight = 0.0f;
};

/// What a picture shows of the volume at a point of a surface: the mean over the sides of the cells around that see it
/// (docs/theory.md#reconstruction). For grids that are too large for buffers of the GPU, and wherever there is none.
/// Twin: shaders/screen/bounces/volume/volume_gather.glsl. Thread-safe.
/// @param irradiance  of the sides of `voxels`. @param position, normal  world, the normal on the viewer's side.
/// @param viewer  xyz position, w 1; or towards the viewer, w 0.
PixelIrradiance irradiance_at_pixel(const VoxelGrid& voxels, const SideIrradiance& irradiance, glm::vec3 position,
                                    glm::vec3 normal, glm::vec4 viewer);

/// Of nested grids: what the innermost one shows that has the point, and over the last cell before its rim more and
/// more of what the one around shows. @param irradiance  by level.
PixelIrradiance irradiance_at_pixel(const VolumeSides& sides, std::span<const SideIrradiance> irradiance,
                                    glm::vec3 position, glm::vec3 normal, glm::vec4 viewer);

}  // namespace volgi
