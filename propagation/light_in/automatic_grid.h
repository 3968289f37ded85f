#pragma once
#include <optional>

#include "core/scene.h"
#include "voxel/grid.h"

namespace volgi {

/// What a scene asks of cells, lights and clusters.
struct SceneFacts {
  float edge_m = 0.0f;     // longest, of what the grid lies around
  int cells = 48;          // automatic_grid_cells()
  float feature_m = 0.0f;  // 3 % of the light that leaves lit and emissive surfaces meets another one nearer than this
  float flight_m = 0.0f;   // and half of it
  float lit_area_m2 = 0.0f;  // of those surfaces: as much as all alike would have to be for a light's share of power
  int lamps = 0;             // lights, and one where something emits
};
/// @param cells  where they are known: nobody looks for passages. Cost: as automatic_grid_cells(). @throws Error as
/// make_grid.
SceneFacts scene_facts(const Scene& scene, const std::optional<GridBox>& box = {}, std::optional<int> cells = {});

/// Cells along the longest axis that suit a scene, where nobody asks for a number: those of its size
/// (grid_cells_by_size), and more until
/// - under 3 % of the light that leaves lit and emissive surfaces meets another one nearer than a cell: what flies
///   shorter the volume does not carry right. Steps, a lamp's slit under the ceiling;
/// - what air joins is joined by cells, through doors ajar (voxel/passages.h);
/// with 256 along an axis, and 2^20 in all, at most. Cost: 2^14 rays, and what passages.h says; once for a scene.
/// @param box  as make_grid. @throws Error as make_grid.
int automatic_grid_cells(const Scene& scene, const std::optional<GridBox>& box = {});

}  // namespace volgi
