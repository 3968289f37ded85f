#pragma once
// Which cells around one lie on its side of surfaces. Twin: shaders/propagation/neighbourhood.glsl.
#include <bitset>

#include "voxel/voxel_grid.h"

namespace volgi {

using Around = std::bitset<27>;  // the 3^3 cells around one

inline size_t around_index(glm::ivec3 d) { return size_t(d.x + 1) + 3 * size_t(d.y + 1) + 9 * size_t(d.z + 1); }
inline glm::ivec3 around_offset(size_t k) { return glm::ivec3(k % 3, (k / 3) % 3, k / 9) - 1; }

/// Cells around `centre` that three steps lead to without crossing a face that stops everything: a corner of the cube
/// is three steps away.
inline Around reachable_cells(const VoxelGrid& voxels, glm::ivec3 centre) {
  Around reached, edge;
  edge.set(around_index(glm::ivec3(0)));
  for (int step = 0; step < 3; ++step) {
    reached |= edge;
    Around next;
    for (size_t k = 0; k < edge.size(); ++k) {
      if (!edge[k]) continue;
      const glm::ivec3 d = around_offset(k);
      const glm::uvec2 own = voxels.cell_sides(centre + d);
      for (int face = 0; face < 6; ++face) {
        const glm::ivec3 to = d + shared::face_step(face);
        if (glm::any(glm::greaterThan(glm::abs(to), glm::ivec3(1)))) continue;
        if (!shared::is_opaque(own, face) && shared::cell_inside(voxels.grid(), centre + to))
          next.set(around_index(to));
      }
    }
    edge = next & ~reached;
  }
  return reached | edge;
}

}  // namespace volgi
