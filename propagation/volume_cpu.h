#pragma once
#include <memory>
#include <optional>

#include "core/mipmaps.h"
#include "core/scene.h"
#include "propagation/bounces_cpu.h"
#include "propagation/pulse_volume_cpu.h"
#include "propagation/volume_options.h"
#include "voxel/cell_volumes.h"
#include "voxel/expected_sides.h"

namespace volgi {

/// The volume subsystem on the CPU, without any GL: voxelization, propagation, irradiance per side, each apart for
/// timers. Light comes as SideFlux from whoever has it: of lamps and emissive surfaces
/// propagation/light_in/direct_light_cpu.h, of virtual lights propagation/light_in/reflected_flux_cpu.h.
class VolumeCpu {
 public:
  /// @param scene  must outlive the volume.
  /// @throws Error(usage) for options that make no sense, Error(over_limit) above options.memory_limit, and as
  ///   make_grid.
  /// @param ranks  that hold the volume together: this one then has a part, and all do everything below together, to
  ///   the same numbers as one alone. Parts are of as many blocks each; where one of them would need more than
  ///   options.memory_limit, ranks are lean (RanksOfVolume), and where that is not enough parts are cut so that the
  ///   largest need is least. Null: there is one.
  VolumeCpu(const Scene& scene, const VolumeOptions& options, const Ranks* ranks = nullptr);
  ~VolumeCpu();

  /// The scene has moved within the same grid, in place. Materials, textures and images must be the same.
  void scene_moved();

  /// From the next voxelize() on the grid lies there (VolumeOptions::grid_shift_cells): of pictures that are averaged
  /// each sees the scene in other cells, so that what hangs on where surfaces lie in cells is averaged as well.
  void shift_grid(glm::vec3 cells);

  /// Where propagate() keeps its state and goes on from (BouncesCpu::set_checkpoint); must outlive this. Schemes that
  /// carry sides.
  void set_checkpoint(BounceCheckpoint* checkpoint) { checkpoint_ = checkpoint; }

  /// Of a volume of nested grids: they lie around that point [m] from the next voxelize() on (CascadeOptions::around).
  void move_cascade(glm::vec3 around);

  // In this order:
  void voxelize();
  /// @param flux  of sides().
  void light_in(SideFlux flux);
  /// Before propagate(): gaps between rooms, as wide as they are (light_in/narrow_passages.h). Holds until cells
  /// change.
  void set_passages(std::vector<PassageFace> faces);
  std::span<const PassageFace> passages() const { return passages_; }
  /// Whether cells have changed since set_passages().
  bool passages_are_old() const { return passages_are_old_; }
  void propagate();
  void irradiate();

  const Grid& grid() const { return grid_; }
  const VolumeOptions& options() const { return options_; }
  /// The outermost grid's, or the only one's.
  const VoxelGrid& voxels() const { return levels_.front(); }
  /// Of nested grids, outermost first.
  const Cascade& cascade() const { return cascade_; }
  std::span<const VoxelGrid> levels() const { return levels_; }
  VolumeSides sides() const { return {cascade_, levels_}; }
  const CellVolumes& cells();  // voxelized now if the scheme did not need them
  /// Null where there is one rank.
  const RanksOfVolume* ranks() const { return ranks_ ? &*ranks_ : nullptr; }
  const SideFlux& flux() const { return flux_; }
  /// Of schemes that carry sides. After a first bounce on the screen `indirect` holds bounces 2 ... n of punctual light
  /// and 1 ... n of emission, `direct` nothing.
  const SideIrradiance& irradiance(size_t level = 0) const { return irradiance_[level]; }
  const std::vector<SideIrradiance>& irradiance_of_levels() const { return irradiance_; }
  /// irradiance() without the last order that VolumeOptions::bounces allows: what sides of a picture of so many bounces
  /// reflect. Of one grid and one rank. Cost: irradiate() again.
  SideIrradiance irradiance_but_last() const;
  const BounceReport& report() const { return report_; }
  size_t pocket_cells() const { return pocket_cells_; }  // bound_white_pockets()
  /// Radiance in free space, with the file's world transform. Costs a pass over the volume. Of one grid.
  RadianceVolume radiance() const;
  /// Whether the transport ends pulses on a coarser grid (SchemeOptions::coarse_start).
  bool has_coarse_part() const;
  size_t bytes() const;

 private:
  void share_out(const Ranks& ranks);
  void set_grid();
  std::vector<VoxelGrid> voxelized(bool white);
  std::unique_ptr<TransportCpu> transport() const;
  void voxelize_half(bool white);
  void join_emission(SideIrradiance& irradiance) const;

  const Scene& scene_;
  VolumeOptions options_;
  Grid grid_;
  Cascade cascade_;
  BounceRules rules_;
  Mipmaps mipmaps_;  // of the scene, for all its frames
  std::optional<RanksOfVolume> ranks_, half_ranks_;
  std::optional<SideHalo> halo_;                               // of voxels()
  std::vector<VoxelGrid> levels_ = std::vector<VoxelGrid>(1);  // of the cascade
  VoxelGrid half_voxels_;
  CellVolumes cells_;
  SideFlux flux_;
  std::unique_ptr<BouncesCpu> bounces_;
  std::unique_ptr<PulseVolumeCpu> pulse_;
  std::vector<SideIrradiance> irradiance_ = std::vector<SideIrradiance>(1);  // by level
  BounceReport report_;
  size_t pocket_cells_ = 0;
  BounceCheckpoint* checkpoint_ = nullptr;
  std::vector<PassageFace> passages_;
  bool passages_are_old_ = true;
  bool moved_ = false, shifted_ = false;  // since the last voxelization
};

/// Memory that a volume on the CPU is going to take [bytes], VolumeCpu::bytes() after a run, for what is said and
/// refused before it is taken: the sum of what its parts say of themselves.
size_t bytes_expected_cpu(const Scene& scene, const Grid& grid, const VolumeOptions& options,
                          const ExpectedSides& expected);
/// The same of nested grids.
size_t bytes_expected_cpu(const Scene& scene, const Cascade& cascade, const VolumeOptions& options);
/// The same of the volume's part that this rank has.
size_t bytes_expected_cpu(const Scene& scene, const Grid& grid, const VolumeOptions& options,
                          const RanksOfVolume& ranks);

}  // namespace volgi
