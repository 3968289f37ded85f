#pragma once
#include <nlohmann/json.hpp>

#include "core/scene.h"

namespace volgi::app {

/// Times of the CPU's voxelization, and of OpenVDB's meshToVolume (narrow band of one cell on both sides, same spacing)
/// in the same run: the limit is on their ratio. Medians over `repeats` runs that take turns, after one that
/// warms up; all threads. Made before and not timed: the textures' mipmaps, which a scene that
/// moves keeps (voxelization_mipmaps; VolumeCpu does the same), and meshToVolume's list of points and triangles, which
/// it would not keep. All else is timed, memory given back included.
/// @return {"scene", "triangles", "threads", "grid": [x,y,z], "sides", "cells", "repeats", "sides_ms", "cells_ms",
///   "all_ms", "mesh_to_volume_ms", "mesh_to_volume_over_{cells,sides,all}"}: cells_ms for occupancy, albedo, normal
///   and emission of cells as OpenVDB grids (cell_volumes_cpu), sides_ms for blocked faces and their sides with
///   coverage, normal, albedo, emission and area (voxelize_cpu), all_ms for both in one go.
/// Source: docs/theory.md#voxelization; Museth 2013, "VDB: High-Resolution Sparse Volumes with Dynamic Topology".
nlohmann::json bench_voxelize(const Scene& scene, int grid_cells, int repeats);
std::string voxelize_table(const nlohmann::json& result);

}  // namespace volgi::app
