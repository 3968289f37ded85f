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

/// Calls visit(number of a side) for the sides around side i that may show the same surface: those of 3^3 cells that
/// can be reached, with normals within 45 degrees.
template <class Visit>
void for_sides_alike(const VoxelGrid& voxels, size_t i, const Visit& visit) {
  const std::vector<shared::Side>& sides = voxels.sides();
  const glm::ivec3 centre = shared::cell_coord(voxels.grid(), sides[i].cell);
  const Around reached = reachable_cells(voxels, centre);
  for (size_t k = 0; k < reached.size(); ++k) {
    if (!reached[k]) continue;
    const glm::uvec2 own = voxels.cell_sides(centre + around_offset(k));
    const size_t last = own.x + shared::count_bits(own.y & 63u);
    for (size_t s = own.x; s < last; ++s) {
      if (glm::dot(sides[s].normal, sides[i].normal) >= SIMILAR_NORMAL_COSINE) visit(s);
    }
  }
}

}  // namespace volgi
