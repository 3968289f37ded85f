#include "voxel/grid.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/scene_detail.h"

namespace volgi {

Grid make_grid(const Scene& scene, int cells_along_longest_axis, glm::vec3 shift_cells,
               const std::optional<GridBox>& box) {
  if (cells_along_longest_axis < 1) throw Error(ExitCode::usage, "--grid needs at least 1 cell");
  if (scene.triangle_count() == 0) {
    throw Error(ExitCode::bad_input, scene.path.string() + ": no triangles, nothing to voxelize (use --gi none)");
  }
  const GridBox around = box.value_or(GridBox{scene.bounds_min, scene.bounds_max});
  glm::dvec3 extent = glm::dvec3(around.max) - glm::dvec3(around.min);
  double longest = std::max({extent.x, extent.y, extent.z});
  if (!(longest > 0.0))
    throw Error(ExitCode::bad_input, scene.path.string() + ": all vertices in one point, nothing to voxelize");
  double h = longest / cells_along_longest_axis;
  glm::dvec3 centre = 0.5 * (glm::dvec3(around.max) + glm::dvec3(around.min));
  Grid grid{};
  grid.cell_size_m = float(h);
  for (int axis = 0; axis < 3; ++axis) {
    // A box of 2.0000001 cells has 2: the excess is rounding, and lies within the half cell that outer faces look
    // beyond.
    int cells = std::max(1, int(std::ceil(extent[axis] / h - 1e-4)));
    double origin = centre[axis] - 0.5 * h * cells;
    double shift = shift_cells[axis];
    if (shift != 0.0) {
      ++cells;
      origin += h * (shift > 0.0 ? shift - 1.0 : shift);
    }
    grid.cells[axis] = cells;
    grid.origin[axis] = float(origin);
  }
  return grid;
}

int grid_cells_by_size(const Scene& scene, const std::optional<GridBox>& box) {
  constexpr int LEAST = 48, STEP = 8;
  constexpr double LONGEST_M = 0.3;
  // A house on open ground: the flat grid has room for more cells along it.
  const bool on_ground = !box && detail_box(scene).has_value();
  const int most = on_ground ? 256 : 128;
  const size_t most_cells = size_t(1) << (on_ground ? 18 : 17);
  const glm::vec3 extent = box ? box->max - box->min : scene.bounds_max - scene.bounds_min;
  const double longest = double(std::max({extent.x, extent.y, extent.z}));
  if (!(longest > 0.0) || scene.triangle_count() == 0) return LEAST;
  int cells = LEAST;
  while (cells < most && longest / cells > LONGEST_M &&
         cell_count(make_grid(scene, cells + STEP, glm::vec3(0.0f), box)) <= most_cells)
    cells += STEP;
  return cells;
}

}  // namespace volgi
