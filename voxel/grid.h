#pragma once
#include <glm/glm.hpp>
#include <optional>

#include "core/scene.h"
#include "shaders/shared/grid.shared.h"

namespace volgi {

using shared::Grid;

/// A box in a scene's centred frame [m].
struct GridBox {
  glm::vec3 min{0.0f};
  glm::vec3 max{0.0f};
};

/// N cubic cells along the longest axis of the scene's bounds, as many as needed along the others (rounded up, at least
/// one), box centred in the grid, no padding (docs/conventions.md#space).
/// @param shift_cells  moves the grid by that part of a cell on each axis and adds one cell where it is not zero, so
///                     that the bounds stay inside: for tests of what must not depend on the grid's place.
/// @param box  instead of the scene's bounds: what is outside of it is not in the volume.
/// @throws Error(usage) when N < 1; Error(bad_input) when the scene has no triangles.
Grid make_grid(const Scene& scene, int cells_along_longest_axis, glm::vec3 shift_cells = glm::vec3(0.0f),
               const std::optional<GridBox>& box = {});

/// Cells along the longest axis for a scene of this size: 48, and more of them where they
/// would be longer than 0.3 m, what a pillar is; 128 at most, and no more than 2^17 in all. Twice as many of both for
/// what stands on open ground (core/scene_detail.h). @param box  as make_grid.
int grid_cells_by_size(const Scene& scene, const std::optional<GridBox>& box = {});

inline bool same_grid(const Grid& a, const Grid& b) {
  return a.cells == b.cells && a.origin == b.origin && a.cell_size_m == b.cell_size_m;
}
inline size_t cell_count(const Grid& g) { return size_t(g.cells.x) * size_t(g.cells.y) * size_t(g.cells.z); }

}  // namespace volgi
