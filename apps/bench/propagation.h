#pragma once
#include <nlohmann/json.hpp>

namespace volgi::app {

/// Times of propagation on the CPU (`volgi bench propagation`), medians, all threads: a closed box of albedo 0.7 with a
/// small emitter, solved by each scheme to the same error against its own converged answer; time against cells and
/// against passes with fitted exponents; `conservative` against copying the least memory it could move.
/// @param largest_grid  cells on an edge of the largest box, 32 ... 256.
nlohmann::json bench_propagation(int largest_grid, int repeats);
/// The same for people.
std::string propagation_table(const nlohmann::json& result);

}  // namespace volgi::app
