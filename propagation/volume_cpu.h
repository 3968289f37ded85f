#pragma once
#include <memory>

#include "core/mipmaps.h"
#include "core/scene.h"
#include "core/visibility/embree_scene.h"
#include "core/visibility/virtual_lights_cpu.h"
#include "propagation/bounces.h"
#include "propagation/pulse_volume.h"
#include "propagation/volume_options.h"
#include "voxel/cell_volumes.h"
#include "voxel/expected_sides.h"

namespace volgi {

/// The whole volume subsystem on the CPU, without any GL: voxelization, light in by Embree rays, propagation,
/// irradiance per side. run() does all of it; the stages are apart for timers and for the cross-check.
class VolumeCpu {
 public:
  /// @param scene  must outlive the volume.
  /// @throws Error(usage) for options that make no sense, Error(over_limit) above options.memory_limit, and as
  ///   make_grid.
  VolumeCpu(const Scene& scene, const VolumeOptions& options);
  ~VolumeCpu();

  /// The scene has moved within the same grid, in place: rays and emission meet it where it is now. Materials, textures
  /// and images must be the same. Cost: Embree's tree on one thread, 1 ms for some 2000 triangles.
  void scene_moved();

  void run();
  // The stages of run(), in this order.
  void voxelize();
  void light_in();  // as options.source says
  void propagate();
  void irradiate();

  const Grid& grid() const { return grid_; }
  const VoxelGrid& voxels() const { return voxels_; }
  const CellVolumes& cells();  // voxelized now if the scheme did not need them
  /// After a first bounce: of what virtual lights brought; all of it counts as `punctual` unless orders are counted.
  const SideFlux& flux() const { return flux_; }
  /// Of schemes that carry sides. After a first bounce on the screen `indirect` holds bounces 2 ... n of punctual light
  /// and 1 ... n of emission, `direct` nothing.
  const SideIrradiance& irradiance() const { return irradiance_; }
  const VirtualLightsCpu& virtual_lights() const { return virtual_lights_; }  // of Source::first_bounce
  const BounceReport& report() const { return report_; }
  /// Radiance in free space, with the file's world transform. Costs a pass over the volume.
  RadianceVolume radiance();
  bool emits() const { return emits_; }
  /// Whether the transport ends pulses on a coarser grid (SchemeOptions::coarse_start).
  bool has_coarse_part() const;
  size_t bytes() const;

 private:
  void look_at_geometry();
  void direct_light_in();
  void first_bounce_in();

  const Scene& scene_;
  VolumeOptions options_;
  Grid grid_;
  BounceRules rules_;
  std::unique_ptr<EmbreeScene> embree_;
  std::unique_ptr<EmitterPoints> emitters_;  // of Source::first_bounce
  VirtualLightsCpu virtual_lights_;
  Mipmaps mipmaps_;  // of the scene, for all its frames
  VoxelGrid voxels_, half_voxels_;
  CellVolumes cells_;
  SideFlux flux_;
  std::unique_ptr<Bounces> bounces_;
  std::unique_ptr<PulseVolume> pulse_;
  SideIrradiance irradiance_;
  BounceReport report_;
  bool emits_ = false;
  bool moved_ = false;  // since the last voxelization
};

/// Memory that a volume on the CPU is going to take [bytes], VolumeCpu::bytes() after a run, for what is said and
/// refused before it is taken: the sum of what its parts say of themselves.
size_t bytes_expected_cpu(const Scene& scene, const Grid& grid, const VolumeOptions& options,
                          const ExpectedSides& expected);

}  // namespace volgi
