#include "apps/volgi/in_a_child.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <iostream>

#include "apps/volgi/failure.h"
#include "core/error.h"

namespace volgi::app {

namespace {

/// Without what runs at an exit: it waits for threads that libraries have made as they were loaded, in the parent only.
[[noreturn]] void answer(const std::function<int()>& work) {
  int code = 0;
  try {
    code = work();
  } catch (...) {
    code = say_failure();
  }
  std::cout.flush();
  std::fflush(nullptr);
  _exit(code);
}

}  // namespace

int in_a_child(const std::filesystem::path& file, const std::function<int()>& work) {
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child < 0) return work();  // as well as can be
  if (child == 0) {
    const rlimit none{0, 0};  // a crash is an answer here, and leaves no core file
    setrlimit(RLIMIT_CORE, &none);
    answer(work);
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) throw Error(ExitCode::bad_input, file.string() + ": the process that reads it is lost");
  }
  if (WIFEXITED(status)) return WEXITSTATUS(status);
  throw Error(ExitCode::bad_input,
              fmt::format("{}: damaged: OpenVDB ends at it with signal {}", file.string(), WTERMSIG(status)));
}

}  // namespace volgi::app
