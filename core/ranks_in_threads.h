#pragma once
#include <functional>

#include "core/ranks.h"

namespace volgi {

/// Runs `work` once for each of so many ranks, every one a thread of this process: what runs over MPI runs here as
/// well, without any. Waits for all; where one of them throws the others end at their next wait, and its exception
/// comes out.
void run_ranks_in_threads(int count, const std::function<void(const Ranks& ranks)>& work);

}  // namespace volgi
