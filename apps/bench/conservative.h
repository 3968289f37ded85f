#pragma once
#include <nlohmann/json.hpp>
#include <span>

#include "voxel/voxel_grid.h"

namespace volgi::app {

/// `conservative` on the CPU, order 1, in a closed box of cells^3 with every leaf lit, against copying what a pass must
/// at least read and write: state and what sides received, each read once and written once.
/// Passes and copies take turns, at least five times.
/// @return cells, threads, iterations, ms_per_iteration, copy_ms, ratio (medians), ratio_range, bytes (of a pass).
nlohmann::json bench_conservative(int cells, int iterations, int repeats);

/// Sparse leaves against all leaves in every pass, over a pulse's first passes; in turn, at least five times.
/// @param sent  power per side [W].
/// @return sparse_ms, dense_ms (per pass), speedup (medians), speedup_range, leaves, lit_leaves (after the last pass),
/// iterations, lit_shares (leaves, rows, cells: of all, mean over what passes left; one over them is the most that
/// sparse storage can gain).
nlohmann::json bench_sparse(const VoxelGrid& voxels, std::span<const glm::vec4> sent, int iterations, int repeats);

}  // namespace volgi::app
