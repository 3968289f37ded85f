#pragma once
#include <memory>

#include "core/scene.h"
#include "core/visibility/embree_scene.h"
#include "propagation/side_flux.h"
#include "propagation/volume_cpu.h"
#include "voxel/voxel_grid.h"

namespace volgi {

/// What lamps and emissive surfaces give a volume on the CPU: the flux that they send and that surfaces under them
/// reflect, by rays through the texels of what a reflective shadow map would be, which meet triangles (Embree) or the
/// grid's own faces (VolumeOptions::first_light). Twins:
/// propagation/side_flux_gl.h and screen/bounces/volume/inject_reflective_shadow_map.h.
class DirectLightCpu {
 public:
  /// @param scene  must outlive this. @param by_rays  lights_by_rays().
  explicit DirectLightCpu(const Scene& scene, bool by_rays = true);
  /// The scene has moved, in place. Cost: Embree's tree on one thread, 1 ms for some 2000 triangles.
  void scene_moved();
  /// Cost: some 16 rays for each lit cell's face.
  SideFlux flux(const VolumeSides& sides) const;
  /// All ranks, the rays shared out; each has the whole scene's tree, or the whole grid's faces.
  SideFlux flux(const VoxelGrid& voxels, const RanksOfVolume& ranks) const;
  /// Of the scene, made when it is asked for where there are no punctual lights. None of light by the grid's faces.
  const EmbreeScene* embree() const;

 private:
  const Scene& scene_;
  bool by_rays_;
  mutable std::unique_ptr<EmbreeScene> embree_;  // none without punctual lights or rays, until embree()
};

/// Direct light of a volume, or of a rank's part of one.
SideFlux direct_light(const Scene& scene, const VolumeCpu& volume);

/// All of a volume: voxels, direct light, propagation, irradiance.
void run_with_direct_light(VolumeCpu& volume, const Scene& scene);

}  // namespace volgi
