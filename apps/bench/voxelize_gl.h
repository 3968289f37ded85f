#pragma once
#include <nlohmann/json.hpp>

#include "core/scene.h"

namespace volgi::app {

/// The GPU's voxelization: three slices, a single pass, and slices along one axis a frame (VoxelizationOptions).
/// Medians over `repeats` runs between two glFinish, after three that warm up. Needs a current gl::Context.
/// @return {"scene", "triangles", "grid": [x,y,z], "repeats", "methods": [{"name", "ms", "sides", "holes", "extra",
///   "differing"}]}: against three slices, sides that are missing, sides that only this method has, and those of both
///   that differ in any byte.
nlohmann::json bench_voxelize_gl(const Scene& scene, int grid_cells, int repeats);
std::string voxelize_gl_table(const nlohmann::json& result);

}  // namespace volgi::app
