#include "voxel/side_halo.h"

#include "core/error.h"
#include "voxel/slice_internal.h"

namespace volgi {

SideHalo::SideHalo(const RanksOfVolume& ranks, const VoxelGrid& voxels)
    : ranks_(ranks.ranks), own_(size_t(ranks_.count())), foreign_(size_t(ranks_.count())) {
  struct Near {
    size_t rank;
    glm::ivec3 first, last;  // cells whose sides it knows
  };
  const glm::ivec3 known(0, slicing::kSidesKnownAround, slicing::kSidesKnownAround);
  std::vector<Near> near;
  for (int rank = 0; rank < ranks_.count(); ++rank) {
    const BlockBox part = ranks.decomposition.part(rank);
    if (rank == ranks_.rank() || part.empty()) continue;
    near.push_back({size_t(rank), kLeafCells * part.first - known, kLeafCells * part.last + known});
  }
  for (std::uint32_t i = 0; i < voxels.sides().size(); ++i) {
    const glm::ivec3 cell = shared::cell_coord(voxels.grid(), voxels.sides()[i].cell);
    if (i >= voxels.side_count()) {
      foreign_[size_t(ranks.decomposition.owner(cell / kLeafCells))].push_back(i);
      continue;
    }
    for (const Near& n : near) {
      if (glm::all(glm::greaterThanEqual(cell, n.first)) && glm::all(glm::lessThan(cell, n.last)))
        own_[n.rank].push_back(i);
    }
  }
}

void SideHalo::check(bool agree) {
  if (!agree)
    throw Error(
        ExitCode::bad_input,
        "ranks do not agree about the sides between their parts: do all run the same program on the same scene?");
}

}  // namespace volgi
