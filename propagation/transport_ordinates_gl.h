#pragma once
#include <optional>
#include <vector>

#include "core/gl/objects.h"
#include "core/gl/program.h"
#include "propagation/ordinates.h"
#include "propagation/scheme.h"
#include "propagation/transport_gl.h"

namespace volgi {

/// `ordinates`: the discrete-ordinates (S_N) method of neutron transport. Every cell holds a power per direction; it
/// leaves through the downwind faces by the step or the characteristic rule (ordinates.h, cell_transfer), and one sweep
/// per octant solves an order exactly. Conserves, is positive, linear and reciprocal: lights superpose. Lateral spread
/// stands in for the directions between (docs/theory.md#ordinates, with what it cannot do: narrow ducts, sharp first
/// bounces). Cost of an order: one visit of each cell per octant in x+y+z-2 dispatches; a visit reads three and writes
/// one (step) or three (characteristic) texels of four numbers per four numbers of direction and band. Memory: two
/// diagonal planes per octant, 8 bytes a cell, 80 bytes a side.
class OrdinatesTransportGl : public TransportGl {
 public:
  /// Directions and rule by choose_ordinates. @throws Error(usage) as ordinate_set.
  OrdinatesTransportGl(const Grid& grid, const SchemeOptions& options);
  OrdinatesTransportGl(const Grid& grid, int directions, Ordinates rule = Ordinates::step);

  void carry(const VoxelGridGl& voxels, const gl::Buffer& sent, const gl::Buffer& received, const BounceRules& rules,
             BounceReport& report) override;
  RadianceVolumeGl radiance(const VoxelGridGl& voxels, const gl::Buffer& sent) override;
  bool iterative() const override { return false; }
  size_t bytes() const override;

 private:
  void list_diagonals();
  void prepare(const VoxelGridGl& voxels, const gl::Buffer& sent);
  void sweep(const gl::Program& program, int first_octant, int octants);
  std::vector<std::string> defines(bool radiance) const;
  gl::Buffer pack_shares(const OrdinateSet& set) const;

  Grid grid_{};
  Ordinates rule_;
  int texels_;  // of one cell and octant: powers by direction and band, four a texel
  gl::Program prepare_, sweep_, collect_;
  std::optional<gl::Program> read_out_;  // compiled when asked for
  gl::Buffer shares_;
  gl::Texture planes_[2];                         // columns x octants, texels and (characteristic) faces
  gl::Texture cell_word_, side_light_, arrived_;  // prepare_sweep.comp.glsl, sweep.comp.glsl
  gl::Texture column_map_;
  std::vector<int> first_cell_;  // of each diagonal in column_map_, and their end
  std::uint32_t capacity_ = 0;
};

}  // namespace volgi
