#pragma once
#include <vector>

#include "core/mipmaps.h"
#include "core/scene.h"
#include "voxel/cascade.h"
#include "voxel/voxel_grid.h"

namespace volgi {

/// Every grid of a cascade voxelized apart (voxelize_cpu), with a block around the inner ones, so that a fine grid
/// costs what it holds; then sides in cells that another grid takes the place of go, and at its rim the faces of its
/// cells and the ratio^2 times larger one of the cell outside are made to stop the same light.
///
/// Such a face is shut where a surface crosses the segment from the fine cell's centre to that of its like beyond the
/// rim, or where an opaque side of the cell outside has that second centre behind it, or one of that fine cell's sides
/// the outer one's centre. So a journey from cell to cell is still a polyline, of centres, that no surface crosses
/// (docs/theory.md#sides), as far as surfaces are planes within a cell. The cell outside has one side with the mean
/// coverage of the fine faces: what they stop and what it stops is the same power. Where one of the two grids has no
/// side of its own there, it takes the other one's surface.
/// @param pocket_cells  of bound_white_pockets() on all grids is added, where it is not null.
/// @return  by level, outermost first.
std::vector<VoxelGrid> voxelize_cascade(const Scene& scene, const Cascade& cascade, const Mipmaps& mipmaps,
                                        size_t* pocket_cells = nullptr);

/// Share that a face between two levels lets pass (1 - coverage), of the side of `cell` on `face`; 1: it has none.
inline float open_share(const VoxelGrid& voxels, glm::ivec3 cell, int face) {
  const glm::uvec2 own = voxels.cell_sides(cell);
  if (!shared::has_side(own, face)) return 1.0f;
  const float coverage = voxels.sides()[shared::side_index(own, face)].coverage;
  return 1.0f - (coverage < 1.0f ? coverage : 1.0f);
}

/// Calls visit(cell, face, fine_cell) for every cell outside a level's next one that has it beyond `face`; fine_cell is
/// the first of the ratio^2 cells of the next level there, along each axis the least.
template <class Visit>
void for_each_cell_at_rim(const Cascade& cascade, size_t level, const Visit& visit) {
  const BlockBox& box = cascade.inside[level];
  const glm::ivec3 first = kLeafCells * box.first, last = kLeafCells * box.last;
  for (int face = 0; face < 6; ++face) {
    const int axis = shared::face_axis(face), b = shared::axis_b(axis), c = shared::axis_c(axis);
    const bool up = shared::face_sign(face) > 0;  // the next level is above the cell
    glm::ivec3 cell, fine;
    cell[axis] = up ? first[axis] - 1 : last[axis];
    if (cell[axis] < 0 || cell[axis] >= cascade.grids[level].cells[axis]) continue;
    fine[axis] = up ? 0 : cascade.ratio * (last[axis] - first[axis]) - 1;
    for (cell[c] = first[c]; cell[c] < last[c]; ++cell[c]) {
      for (cell[b] = first[b]; cell[b] < last[b]; ++cell[b]) {
        fine[b] = cascade.ratio * (cell[b] - first[b]);
        fine[c] = cascade.ratio * (cell[c] - first[c]);
        visit(cell, face, fine);
      }
    }
  }
}

}  // namespace volgi
