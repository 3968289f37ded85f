#include "apps/volgi/program_ranks.h"

#include <fmt/format.h>

#include <signal.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <iostream>
#include <optional>
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

std::vector<pid_t> other_processes;  // ranks on this machine
sockaddr_un speaker{};               // address that the one who speaks takes; ends with it
volatile sig_atomic_t ending = 0;

/// Where a rank has died, the launcher ends the others in this way: one of them says so, in one line. Nothing but what
/// a handler may call.
extern "C" void ended_by_launcher(int) {
  usleep(50000);  // another thread may be about to learn that it has been said
  if (ending != 0) _exit(128 + SIGTERM);
  ending = 1;
  const int own = socket(AF_UNIX, SOCK_DGRAM, 0);
  if (bind(own, reinterpret_cast<const sockaddr*>(&speaker), sizeof speaker) != 0) _exit(128 + SIGTERM);
  constexpr char kLine[] = "volgi: ended by mpirun: another rank has died, or the job was stopped\n";
  [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, kLine, sizeof kLine - 1);
  usleep(200000);  // until the others have seen that it has been said
  _exit(128 + SIGTERM);
}

/// From a rank that has said what is wrong.
extern "C" void end_in_silence(int) { ending = 1; }

void speak_when_ended() {
  speaker.sun_family = AF_UNIX;  // an abstract one: no file
  const std::string name = fmt::format("volgi-ended-{}", getppid());
  std::copy(name.begin(), name.end(), speaker.sun_path + 1);
  struct sigaction action {};
  action.sa_handler = ended_by_launcher;
  sigaction(SIGTERM, &action, nullptr);
  action.sa_handler = end_in_silence;
  sigaddset(&action.sa_mask, SIGTERM);  // where both have come, this one is first
  sigaction(SIGUSR1, &action, nullptr);
}

void find_other_processes(const Ranks& ranks) {
  const std::array<double, 2> own{double(getpid()), double(gethostid())};
  const std::vector<double> all = ranks.gather(own);
  for (int rank = 0; rank < ranks.count(); ++rank) {
    const size_t of = 2 * size_t(rank);
    if (rank != ranks.rank() && all[of + 1] == own[1]) other_processes.push_back(pid_t(all[of]));
  }
}
#endif

}  // namespace

ProgramRanks::ProgramRanks([[maybe_unused]] int& argc, [[maybe_unused]] char**& argv) {
  if (launched_ranks() == 0) return;
#ifdef VOLGI_HAS_MPI
  if (launched_ranks() > 1) speak_when_ended();
  mpi().emplace(argc, argv);
  if (!is_first_rank()) set_quiet(true);
  if (program_ranks() != nullptr) find_other_processes(*program_ranks());
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
  if (program_ranks() == nullptr) return;
  for (const pid_t process : other_processes) kill(process, SIGUSR1);
  mpi()->abort(code);
#endif
}

namespace {

/// What fails on rank 0 as well is said there, and ends the others meanwhile.
void let_the_first_speak() {
  constexpr auto kFirstSpeaks = std::chrono::milliseconds(300);
  if (!is_first_rank()) std::this_thread::sleep_for(kFirstSpeaks * (1 + program_ranks()->rank()));
}

}  // namespace

int ProgramRanks::end_all_alike(int code) const {
  let_the_first_speak();
  end_all(code);
  return code;
}

int ProgramRanks::say_failure() const {
  let_the_first_speak();
  if (is_first_rank()) return app::say_failure();
  std::cerr << fmt::format("volgi: rank {}: ", program_ranks()->rank());
  return app::say_failure();
}

void refuse_several_ranks(const char* command) {
  if (program_ranks() != nullptr)
    throw Error(ExitCode::usage,
                fmt::format("volgi {} runs as one rank; of several there are export, render and bench mpi", command));
}

}  // namespace volgi::app
