#include "apps/volgi/program_ranks.h"

#include <fmt/format.h>

#include <chrono>
#include <cstdlib>
#include <iostream>
#include <optional>
#include <sstream>
#include <thread>

#include "apps/volgi/failure.h"
#include "core/error.h"
#include "core/log.h"
#ifdef VOLGI_HAS_MPI
#include "core/mpi/ranks_mpi.h"
#endif

namespace volgi::app {

namespace {

/// How many a launcher has started: Open MPI's and MPICH's ways of saying so. 0: none has.
int launched_ranks() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"}) {
    if (const char* text = std::getenv(name)) return std::atoi(text);
  }
  return 0;
}

#ifdef VOLGI_HAS_MPI
std::optional<MpiRanks>& mpi() {
  static std::optional<MpiRanks> ranks;
  return ranks;
}
#endif

}  // namespace

ProgramRanks::ProgramRanks([[maybe_unused]] int& argc, [[maybe_unused]] char**& argv) {
  if (launched_ranks() == 0) return;
#ifdef VOLGI_HAS_MPI
  mpi().emplace(argc, argv);
  if (!is_first_rank()) set_quiet(true);
#else
  if (launched_ranks() > 1)
    throw Error(ExitCode::usage,
                "started as several ranks, but built without MPI: configure with -DVOLGI_MPI=ON, as ./run mpi does");
#endif
}

ProgramRanks::~ProgramRanks() {
#ifdef VOLGI_HAS_MPI
  mpi().reset();
#endif
}

const Ranks* program_ranks() {
#ifdef VOLGI_HAS_MPI
  if (mpi() && mpi()->ranks().count() > 1) return &mpi()->ranks();
#endif
  return nullptr;
}

void ProgramRanks::end_all([[maybe_unused]] int code) const {
#ifdef VOLGI_HAS_MPI
  if (program_ranks() != nullptr) mpi()->abort(code);
#endif
}

int ProgramRanks::say_failure() const {
  // What fails on rank 0 as well is said there, and ends the others meanwhile.
  constexpr auto kFirstSpeaks = std::chrono::milliseconds(300);
  if (is_first_rank()) return app::say_failure();
  std::this_thread::sleep_for(kFirstSpeaks * (1 + program_ranks()->rank()));
  std::cerr << fmt::format("volgi: rank {}: ", program_ranks()->rank());
  return app::say_failure();
}

void refuse_several_ranks(const char* command) {
  if (program_ranks() != nullptr)
    throw Error(ExitCode::usage, fmt::format("volgi {} runs as one rank; of several there are export, render with "
                                             "--gi volume --backend cpu, and bench mpi",
                                             command));
}

}  // namespace volgi::app
