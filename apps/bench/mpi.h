#pragma once
#include <nlohmann/json.hpp>

#include "core/ranks.h"

namespace volgi::app {

/// Pipelined sweeps of `ordinates` over the ranks that mpirun has started (`volgi bench mpi`), beside what a model of
/// them (propagation/sweep/sweep_model.h) says of the same, from latency, bandwidth and time per block measured at the
/// start: a closed box, all of whose sides send. Strong scaling, cells^3 for all; weak, cells^3 a rank; the time of one
/// rank with as many threads; and what the model says of more ranks. Medians, one thread a rank. All ranks.
/// @param ranks  null: there is one.
nlohmann::json bench_mpi(const Ranks* ranks, int cells, int repeats);
/// The same for people.
std::string mpi_table(const nlohmann::json& result);

}  // namespace volgi::app
