#include "core/claims.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <map>

namespace volgi {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

class ClaimsTest : public ::testing::Test {
 protected:
  void TearDown() override { fs::remove_all(folder_); }

  /// Another process that does something with the folder and then waits to be killed, or ends.
  template <typename Action>
  pid_t worker(Action&& action) const {
    const pid_t process = fork();
    if (process == 0) {
      action();
      _exit(0);
    }
    return process;
  }
  static void wait_for_file(const fs::path& file) {
    while (!fs::exists(file)) std::this_thread::sleep_for(2ms);
  }
  void foreign_claim(const std::string& name, std::chrono::seconds age) const {
    fs::create_directories(folder_);
    const fs::path file = folder_ / (name + ".claim");
    std::ofstream(file) << "another-machine/pid:[1] 17 4711\n";
    const timespec then{time(nullptr) - age.count(), 0};
    const timespec times[2] = {then, then};
    utimensat(AT_FDCWD, file.c_str(), times, 0);
  }

  const fs::path folder_ = fs::temp_directory_path() / ("volgi_claims_" + std::to_string(getpid()));
};

TEST_F(ClaimsTest, APieceHasOneOwnerUntilItIsGivenBack) {
  Claims one(folder_), other(folder_);
  {
    const auto claim = one.take("a");
    EXPECT_TRUE(claim);
    EXPECT_FALSE(one.take("a"));
    EXPECT_FALSE(other.take("a"));
    EXPECT_TRUE(other.take("b"));
  }
  EXPECT_TRUE(other.take("a"));
  EXPECT_FALSE(fs::exists(folder_ / "a.claim"));
  for (const auto& entry : fs::directory_iterator(folder_)) EXPECT_EQ(entry.path().filename(), "lock");
}

TEST_F(ClaimsTest, WhatAKilledProcessHeldIsTakenOverAtOnceAndNotBefore) {
  Claims claims(folder_);
  const pid_t process = worker([&] {
    Claims own(folder_);
    const auto claim = own.take("a");
    std::ofstream(folder_ / "held");
    pause();
  });
  wait_for_file(folder_ / "held");
  EXPECT_FALSE(claims.take("a"));
  kill(process, SIGKILL);
  siginfo_t info;
  waitid(P_PID, id_t(process), &info, WEXITED | WNOWAIT);
  EXPECT_TRUE(claims.take("a"));  // of a process that nobody has buried
  waitpid(process, nullptr, 0);
  EXPECT_TRUE(claims.take("a"));
}

TEST_F(ClaimsTest, WhatAnotherMachineHoldsIsTakenOverWhenItHasBeenSilentForLong) {
  foreign_claim("fresh", 10s);
  foreign_claim("stale", 90s);
  Claims claims(folder_, 60s);
  EXPECT_FALSE(claims.take("fresh"));
  EXPECT_TRUE(claims.take("stale"));
}

// Killed between the end of a piece and giving it back, whether the others had seen it done by then or not.
TEST_F(ClaimsTest, OfAPieceThatIsDoneADeadClaimIsClearedAway) {
  foreign_claim("piece0", 90s);
  foreign_claim("piece1", 10s);  // lives
  Claims claims(folder_, 60s);
  claims.work(
      2, [](int k) { return "piece" + std::to_string(k); }, [](int) { return true; },
      [](int) { ADD_FAILURE() << "it was done"; });
  EXPECT_FALSE(fs::exists(folder_ / "piece0.claim"));
  EXPECT_TRUE(fs::exists(folder_ / "piece1.claim"));
}

TEST_F(ClaimsTest, AHeldClaimIsRenewed) {
  Claims claims(folder_, 120ms);
  const auto claim = claims.take("a");
  struct stat before {
  }, after{};
  ASSERT_EQ(stat((folder_ / "a.claim").c_str(), &before), 0);
  std::this_thread::sleep_for(200ms);
  ASSERT_EQ(stat((folder_ / "a.claim").c_str(), &after), 0);
  const auto ns = [](const struct stat& s) { return s.st_mtim.tv_sec * 1000000000LL + s.st_mtim.tv_nsec; };
  EXPECT_GT(ns(after), ns(before) + 100'000'000);
}

TEST_F(ClaimsTest, WhatWasTakenFromASleeperIsNotGivenBackByIt) {
  Claims claims(folder_);
  {
    const auto claim = claims.take("a");
    foreign_claim("a", 0s);  // somebody has taken it over
  }
  EXPECT_TRUE(fs::exists(folder_ / "a.claim"));
}

// Of twelve that find a dead claim in one moment, one gets it.
TEST_F(ClaimsTest, ADeadClaimGoesToOne) {
  constexpr int WORKERS = 12;
  for (int round = 0; round < 8; ++round) {
    const std::string name = "piece" + std::to_string(round);
    foreign_claim(name, 1000s);
    const fs::path go = folder_ / ("go" + std::to_string(round));
    std::vector<pid_t> processes;
    for (int k = 0; k < WORKERS; ++k) {
      processes.push_back(worker([&] {
        Claims own(folder_);
        wait_for_file(go);
        const auto claim = own.take(name);
        if (claim) std::ofstream(folder_ / (name + ".won" + std::to_string(k)));
        if (claim) std::this_thread::sleep_for(300ms);  // until all have asked
      }));
    }
    std::this_thread::sleep_for(20ms);
    std::ofstream{go};
    for (const pid_t process : processes) waitpid(process, nullptr, 0);
    int winners = 0;
    for (const auto& entry : fs::directory_iterator(folder_))
      winners += entry.path().filename().string().starts_with(name + ".won");
    EXPECT_EQ(winners, 1);
  }
}

// Four workers, one of them killed at its third piece: each piece is finished by exactly one.
TEST_F(ClaimsTest, WorkersShareThePiecesOfOneThatIsKilled) {
  constexpr int PIECES = 40, WORKERS = 4;
  fs::create_directories(folder_);
  const auto line_of = [](int k, int worker) { return std::to_string(k) + " " + std::to_string(worker) + "\n"; };
  std::vector<pid_t> processes;
  for (int w = 0; w < WORKERS; ++w) {
    processes.push_back(worker([&] {
      Claims own(folder_);
      int begun = 0;
      own.work(
          PIECES, [](int k) { return "piece" + std::to_string(k); },
          [&](int k) { return fs::exists(folder_ / ("done" + std::to_string(k))); },
          [&](int k) {
            if (w == 0 && ++begun == 3) kill(getpid(), SIGKILL);
            std::this_thread::sleep_for(5ms);
            std::ofstream(folder_ / "log", std::ios::app) << line_of(k, w);
            std::ofstream(folder_ / ("done" + std::to_string(k)));
          });
    }));
  }
  std::vector<int> status(WORKERS);
  for (int w = 0; w < WORKERS; ++w) waitpid(processes[size_t(w)], &status[size_t(w)], 0);
  EXPECT_TRUE(WIFSIGNALED(status[0]));
  std::map<int, int> times, of_worker;
  std::ifstream log(folder_ / "log");
  for (int k = 0, w = 0; log >> k >> w;) ++times[k], ++of_worker[w];
  EXPECT_EQ(times.size(), size_t(PIECES));
  for (const auto& [k, count] : times) EXPECT_EQ(count, 1) << "piece " << k;
  EXPECT_EQ(of_worker[0], 2);
  for (int w = 1; w < WORKERS; ++w) EXPECT_GT(of_worker[w], 0) << "worker " << w;
}

}  // namespace
}  // namespace volgi
