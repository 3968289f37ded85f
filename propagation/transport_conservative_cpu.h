#pragma once
#include <memory>
#include <span>
#include <vector>

#include "propagation/lobes/sh_lobes.h"
#include "propagation/lobes/sh_lobes_kernels.h"
#include "propagation/lobes/sh_lobes_walls.h"
#include "propagation/lobes/sh_lobes_wave.h"
#include "propagation/transport_cpu.h"
#include "voxel/expected_sides.h"
#include "voxel/side_halo.h"

namespace volgi {

/// `conservative` on the CPU: power that sides send goes through the grid as lobes of spherical harmonics, one cell a
/// pass, as a pulse (docs/theory.md#conservative). Twin of ConservativeTransportGl.
///
/// A lobe leaves through a face by the flux there of the radiance that it stands for, clamped at zero and rescaled so
/// that the six sum to the lobe's power: in void power is kept to rounding, nothing is negative, isotropic light is a
/// fixed point. Not linear. Cost: leaves of 8^3 cells that light has not reached cost nothing; a lit leaf is read and
/// written once a pass. Memory: 48 bytes a lit cell and state (108 for order 2), two states. Light under 1e-38 W counts
/// as none.
class ConservativeTransportCpu : public TransportCpu {
 public:
  /// @param order    1 (4 coefficients) or 2 (9).
  /// @param half_voxels  the same scene in cells of twice the edge: carries what is left of a pulse to its end (may be
  /// null).
  /// @param kernels  of an instruction set, for tests; null: the machine's best.
  /// @param ranks    that the voxels are parts of, which then do all together: each pass follows on what those beside
  /// sent of the one before. One rank's numbers. Null: there is one.
  /// @param half_ranks  that the half voxels are parts of, of which those of the voxels are twice (Decomposition).
  ConservativeTransportCpu(const VoxelGrid& voxels, int order, const VoxelGrid* half_voxels = nullptr,
                           const LobeKernels* kernels = nullptr, const RanksOfVolume* ranks = nullptr,
                           const RanksOfVolume* half_ranks = nullptr);
  ~ConservativeTransportCpu() override;

  void begin(std::span<const glm::vec4> sent) override;
  bool advance(std::span<glm::vec4> received, int max_passes, const BounceRules& rules, BounceReport& report) override;
  bool iterative() const override { return true; }
  bool linear() const override { return false; }
  RadianceVolume radiance(std::span<const glm::vec4> sent) override;
  size_t bytes() const override;
  /// What bytes() will be where light is everywhere; without the coarse part.
  static size_t bytes_for(const Grid& grid, int order, const ExpectedSides& expected);
  /// Of a rank's part.
  static size_t bytes_for(const RanksOfVolume& ranks, int order, const ExpectedSides& expected);

  // The parts of advance(), for tests and benchmarks.
  /// One pass. @param reflect_hits  what sides receive is sent on at once.
  void pass(std::span<glm::vec4> received, bool reflect_hits);
  glm::dvec3 in_flight() const { return wave_.in_flight(); }  // [W]
  const LobeVolume& lobes() const { return wave_.now(); }
  const LeafNumbers& numbers() const { return wave_.numbers(); }
  void set_dense(bool dense) { wave_.set_dense(dense); }

 private:
  struct CoarsePart;

  static size_t bytes_for(const LeafNumbers& numbers, int order, const ExpectedSides& expected);
  void emit_leaf(int number, std::span<const glm::vec4> sent, float* out, LeafLight& light);
  void pass_leaf(int number, std::span<glm::vec4> received, bool reflect_hits, float* out, LeafLight& light);
  void hit_sides(int number, const LeafWalls& walls, std::uint64_t rows, std::span<glm::vec4> received,
                 bool reflect_hits, float* out);
  void pass_partly(int number, const SideRow& row, int z, float share, float* out);
  void fetch_faces(int number) const;
  bool ended(const BounceRules& rules) const;
  glm::vec3 end_coarsely(std::span<glm::vec4> received, const BounceRules& rules);

  const VoxelGrid& voxels_;
  int order_;
  const RanksOfVolume* ranks_;
  bool half_steps_ = false;  // light moves by half a cell a pass
  LobeKernels kernels_;
  LobeWave wave_;
  std::vector<std::unique_ptr<LeafWalls>> walls_;  // by number of leaf
  float side_lobes_[6][9] = {};

  glm::dvec3 sent_{0.0};       // of the pulse
  int passes_ = 0;             // of the pulse
  glm::dvec3 looked_at_{0.0};  // power in flight when the batch began
  std::unique_ptr<CoarsePart> coarse_;
};

}  // namespace volgi
