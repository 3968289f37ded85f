#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "core/scene.h"

namespace volgi::app {

struct CascadesBenchOptions {
  int size = 96;         // rays along each edge of the picture that is compared
  int fine_cells = 640;  // along the scene's longest axis, of the one fine grid
  float near_m = 8.0f;   // from the camera: what is compared
};

/// Nested grids against one grid with all of its cells as small as theirs are around the camera (`volgi bench
/// cascades`): the light that surfaces near the scene's camera show, by volume alone, all bounces; memory, and the
/// processor's time of voxelization, propagation and irradiance, each measured once; apart from them the rays by which
/// lamps find sides, as many for nested grids as for one.
/// @return scene, fine_cells, near_m, threads; one, cascades [{levels, ratio, cells (of each grid), sides, ms,
/// light_in_ms, bytes, rmse_percent, energy, ms_share, bytes_share}].
nlohmann::json bench_cascades(Scene scene, const CascadesBenchOptions& options);
/// The same for people.
std::string cascades_table(const nlohmann::json& result);

}  // namespace volgi::app
