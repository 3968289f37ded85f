#pragma once
#include <glm/glm.hpp>
#include <memory>
#include <span>

#include "propagation/bounce_rules.h"
#include "propagation/radiance_volume.h"
#include "propagation/scheme.h"
#include "propagation/side_flux.h"
#include "voxel/cell_volumes.h"

namespace volgi {

/// The papers' schemes on the CPU, `lpv2009` and `gaitatzes2010`, as printed: a pulse injected once, reflections in
/// flight, what passes (lpv2009) or bounces (gaitatzes2010) accumulated as spherical harmonics per cell. They know
/// neither sides nor orders (docs/theory.md#papers). Twin of PulseVolumeGl.
class PulseVolumeCpu {
 public:
  /// @param cells  occupancy, normal and albedo for gaitatzes2010, emission for its injection by MAX; must outlive
  /// this.
  PulseVolumeCpu(const VoxelGrid& voxels, const CellVolumes& cells, const SchemeOptions& options);
  ~PulseVolumeCpu();

  /// Injects the flux of sides, as options.injection says (flux: as cosine lobes about their normals, into the cells
  /// that see them; max: without that of emission, which the cells have), and runs `iterations` passes.
  BounceReport run(std::span<const glm::vec4> side_flux, int iterations);
  /// Accumulated radiance, in the frame that pixels read: irradiance on a surface of normal n is the cosine lobe about
  /// -n (directions are those that light travels: docs/conventions.md#spherical-harmonics).
  RadianceVolume radiance() const;
  size_t bytes() const;
  /// What bytes() will be where light is everywhere. @param blocks  with surfaces.
  static size_t bytes_for(const Grid& grid, const SchemeOptions& options, size_t blocks);

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace volgi
