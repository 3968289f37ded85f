#pragma once
#include "core/gl/pass_timer.h"
#include "core/gl/program.h"
#include "core/gl/readback.h"
#include "propagation/bounce_rules.h"
#include "propagation/radiance_volume_gl.h"
#include "propagation/scheme.h"
#include "voxel/voxel_grid_gl.h"

namespace volgi {

/// The papers' schemes, `lpv2009` and `gaitatzes2010`, as printed (shaders/propagation/pulse_*.comp.glsl): a pulse
/// injected once, reflections in flight, what passes (lpv2009) or bounces (gaitatzes2010) accumulated as spherical
/// harmonics per cell. They know neither sides nor orders, and neither keeps power (docs/theory.md#papers). Cost of a
/// pass: 21 texel reads and 6 writes of 16 bytes a cell, and 2 reads more for gaitatzes2010 (order 2: 49 and 14).
/// Memory: 192 bytes a cell (448), and the radiance. Source: Kaplanyan 2009; Gaitatzes 2010 section 4.2. Twin of
/// PulseVolumeCpu.
class PulseVolumeGl {
 public:
  /// What cells hold of surfaces (CellVolumesGl), RGBA textures of the grid's cells. lpv2009 takes any.
  struct Cells {
    const gl::Texture& normal_occupancy;  // mean of the fronts (unit, or zero), occupancy 0 ... 1
    const gl::Texture& albedo;
    const gl::Texture& emission;  // largest radiosity pi L_e; read where options.injection is max
  };

  /// @throws Error(usage) for schemes that carry sides.
  PulseVolumeGl(const Grid& grid, const SchemeOptions& options);

  /// Injects the flux of sides, as options.injection says (flux: as cosine lobes about their normals, into the cells
  /// that see them), and runs `iterations` passes over the volume. Timer "propagation/propagate".
  /// @param side_flux  A B0 of each side [W], vec4, rgb; by MAX without that of emission, which `cells` have.
  BounceReport run(const VoxelGridGl& voxels, const Cells& cells, const gl::Buffer& side_flux, int iterations,
                   gl::PassTimer& timer);

  /// Of the last run, in the frame that pixels read: irradiance on a surface of normal n is the cosine lobe about -n.
  const RadianceVolumeGl& radiance() const { return radiance_; }
  size_t bytes() const { return bytes_for(grid_, options_.sh_order); }
  static size_t bytes_for(const Grid& grid, int sh_order);

 private:
  gl::Program compile(const char* shader) const;
  void dispatch_cells() const;
  void inject(const VoxelGridGl& voxels, const Cells& cells, const gl::Buffer& side_flux);
  void sum_side_flux(const gl::Buffer& side_flux);
  bool by_max() const { return options_.injection == SchemeOptions::Injection::max; }
  void sum_in_flight();
  void pass();
  void read_out();

  Grid grid_{};
  SchemeOptions options_;
  gl::Program inject_, pass_, add_radiance_, sum_sent_, sum_lobes_, sum_partials_;
  gl::Texture lobes_[2], accumulated_[2];  // RGBA32F, lobes.glsl
  int current_ = 0;
  RadianceVolumeGl radiance_;
  gl::Buffer partials_, sum_;
  gl::Readback readback_;
};

}  // namespace volgi
