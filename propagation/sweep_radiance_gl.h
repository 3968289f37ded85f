#pragma once
#include <vector>

#include "core/gl/objects.h"
#include "core/gl/program.h"
#include "propagation/ordinates.h"
#include "propagation/radiance_volume_gl.h"

namespace volgi {

/// Radiance in free space by the `ordinates` scheme: the sweep of OrdinatesTransportGl once more, cell diagonal after
/// cell diagonal and octant after octant, where every cell adds up its directions (sweep_radiance.comp.glsl). For
/// export and tests, not for frames. Memory: two diagonal planes of one octant, and the result.
class SweepRadianceGl {
 public:
  SweepRadianceGl(const Grid& grid, const OrdinateSet& set, Ordinates rule);
  /// @param cell_word, side_light  of prepare_sweep.comp.glsl; the grid is bound.
  RadianceVolumeGl run(const gl::Texture& cell_word, const gl::Texture& side_light);

 private:
  void list_diagonals();
  void sweep(int octant);

  Grid grid_{};
  gl::Program program_;
  gl::Buffer shares_;
  gl::Texture planes_[2];  // columns x texels and (characteristic) faces
  gl::Texture column_map_;
  std::vector<int> first_cell_;  // of each diagonal in column_map_, and their end
};

}  // namespace volgi
