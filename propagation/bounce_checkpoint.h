#pragma once
#include <array>
#include <filesystem>
#include <vector>

#include "core/ranks.h"
#include "propagation/bounce_rules.h"
#include "voxel/voxel_grid.h"

namespace volgi {

/// What a solver of bounces goes on from, between two passes, to the same numbers as if nothing had stopped it. The
/// powers of sides are apart.
struct BounceState {
  int pass = 0;
  BounceReport report;
  glm::dvec3 before{0.0}, residual{0.0};  // of conjugate gradients: sent by emission, and <q,q>
  /// What the state is of, so that none is taken for another's.
  struct Of {
    std::int64_t sides = 0;
    int conjugate_gradients = 0;
    glm::dvec3 emission{0.0}, punctual{0.0};  // power that comes in [W], of all ranks
    glm::ivec3 cells{0};
    friend bool operator==(const Of&, const Of&) = default;
  } of;
};

/// Keeps the state of a run in a folder, every so many passes, and finds it again: each rank a file, in which sides are
/// known by cell and face, so that another number of ranks can go on from it. A run that is killed, at any moment,
/// leaves the last whole state. Cost: 72 bytes a side and time.
class BounceCheckpoint {
 public:
  using Powers = std::vector<glm::vec4>;
  static constexpr int kPowers = 4;

  /// @param ranks  null: there is one. @throws Error(cannot_write) where the folder cannot be made.
  BounceCheckpoint(std::filesystem::path folder, int every, const Ranks* ranks);

  /// All ranks. @param powers  filled, by own side. @return false: there is no state.
  /// @throws Error(bad_input) naming the file that is damaged, or where the state is of something else.
  bool load(const VoxelGrid& voxels, BounceState& state, const std::array<Powers*, kPowers>& powers) const;
  /// All ranks: whether a state is due goes by its pass.
  void keep(const VoxelGrid& voxels, const BounceState& state, const std::array<const Powers*, kPowers>& powers);

 private:
  std::filesystem::path file(int pass, int rank) const;
  void remove_older(int pass) const;

  std::filesystem::path folder_;
  int every_;
  const Ranks* ranks_;
};

}  // namespace volgi
