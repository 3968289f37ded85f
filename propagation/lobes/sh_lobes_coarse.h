#pragma once
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "propagation/lobes/sh_lobes.h"
#include "propagation/lobes/sh_lobes_kernels.h"
#include "voxel/side_halo.h"

namespace volgi {

/// Between a grid and the same scene in cells of twice the edge (same origin): lobes go down to the coarse cells, what
/// coarse sides have received comes back up to the fine sides. Power is kept both ways, but for what is counted as
/// lost. Of several ranks all do everything together; a coarse leaf and the fine ones in it are one rank's
/// (Decomposition::doubled), and what lies beside its part comes from others.
class CoarseLink {
 public:
  /// Ranks that hold the fine and the coarse voxels.
  struct OfRanks {
    const RanksOfVolume& fine;
    const RanksOfVolume& coarse;
  };
  /// @param ranks  none: there is one.
  CoarseLink(const VoxelGrid& fine, const VoxelGrid& coarse, int coefficients, const std::optional<OfRanks>& ranks);

  /// What comes of others' cells for gather(), which follows.
  void fetch_moved(const LobeVolume& fine, const LobeKernels& kernels);

  /// Coarse leaves that hold light of these fine ones, ascending.
  std::vector<int> reached(const LobeVolume& fine) const;
  /// Lobes of a coarse leaf: each cell's the sum of its eight. A fine cell behind a surface that its coarse cell sees
  /// belongs to the coarse cell behind that surface, so that no wall leaks.
  void gather(const LobeVolume& fine, const LobeKernels& kernels, int coarse_leaf, float* out) const;
  /// Adds to each fine side its share, by what it shows to the grid, of what the coarse sides that stand for its centre
  /// have received, evened out linearly between coarse sides. @return what coarse sides without fine ones have received
  /// [W].
  glm::dvec3 spread(std::span<const glm::vec4> coarse_received, std::span<glm::vec4> received) const;
  size_t bytes() const;

 private:
  struct Moved {
    glm::ivec3 from;  // fine cell
    int to;           // offset in the coarse leaf
    int block;        // of the coarse cell that it is in: the order in which they count
    int answer = -1;  // another rank's: where its lobe is in `answers_`
  };
  struct Exceptions {
    std::vector<std::uint8_t> moved_out;  // per cell of the coarse leaf: a bit for each of its eight (x 4, y 2, z 1)
    std::vector<Moved> moved_in;
  };
  struct Share {
    glm::ivec3 sides{-1};  // coarse
    glm::vec3 shares{0.0f};
  };

  void sort_cells(const VoxelGrid& coarse);
  void share_sides(const VoxelGrid& fine, const VoxelGrid& coarse);
  std::vector<double> sums_of_shares(const VoxelGrid& fine, const VoxelGrid& coarse) const;
  void ask_others();
  size_t moved_floats() const { return size_t(coefficients_) * kLobeBands; }
  void moved_lobe(const LobeVolume& fine, const LobeKernels& kernels, glm::ivec3 from, float* lobe) const;
  void find_beside(const VoxelGrid& fine);
  void even_out(int along, std::span<const glm::vec4> from, std::span<glm::vec4> to) const;
  Exceptions& exceptions(int leaf);
  void add_children(const float* lobes, glm::ivec3 octant, const Exceptions* exceptions, float* out) const;
  void add_moved(const LobeVolume& fine, const LobeKernels& kernels, const Moved& moved, float* out) const;

  int coefficients_;
  glm::ivec3 fine_blocks_;
  std::optional<OfRanks> ranks_;
  std::optional<SideHalo> fine_halo_, coarse_halo_;
  std::vector<std::vector<glm::ivec3>> asked_;  // by rank: fine cells whose lobes it wants
  std::vector<float> answers_;                  // lobes of others' fine cells
  size_t known_sides_ = 0;                      // coarse ones
  LeafNumbers fine_numbers_, coarse_numbers_;
  std::vector<std::unique_ptr<Exceptions>> exceptions_;  // by coarse leaf
  std::vector<Share> shares_;                            // by fine side
  std::vector<glm::ivec4> beside_;                       // fine sides: below and above along either axis of the face
  std::vector<float> shown_m2_;                          // by fine side, others' too
  std::vector<std::uint32_t> alone_;                     // coarse sides without fine ones
};

}  // namespace volgi
