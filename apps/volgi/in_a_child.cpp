#include "apps/volgi/in_a_child.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <iostream>
#include <string>

#include "apps/volgi/failure.h"
#include "core/error.h"

namespace volgi::app {

namespace {

/// Without what runs at an exit: it waits for threads that libraries have made as they were loaded, in the parent only.
[[noreturn]] void answer(const std::function<int()>& work) {
  int code = 0;
  try {
    code = with_output_written(work());
  } catch (...) {
    code = say_failure();
  }
  std::fflush(nullptr);
  _exit(code);
}

std::string all_of(int descriptor) {
  std::string text;
  char part[4096];
  for (;;) {
    const ssize_t count = read(descriptor, part, sizeof part);
    if (count > 0) text.append(part, size_t(count));
    if (count == 0 || (count < 0 && errno != EINTR)) return text;
  }
}

}  // namespace

int in_a_child(const std::filesystem::path& file, const std::function<int()>& work) {
  std::fflush(nullptr);
  int said[2];
  if (pipe(said) != 0) return work();  // as well as can be
  const pid_t child = fork();
  if (child < 0) {
    close(said[0]);
    close(said[1]);
    return work();
  }
  if (child == 0) {
    const rlimit none{0, 0};  // a crash is an answer here, and leaves no core file
    setrlimit(RLIMIT_CORE, &none);
    dup2(said[1], STDERR_FILENO);
    close(said[0]);
    close(said[1]);
    answer(work);
  }
  close(said[1]);
  const std::string words = all_of(said[0]);
  close(said[0]);
  int status = 0;
  while (waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) throw Error(ExitCode::bad_input, file.string() + ": the process that reads it is lost");
  }
  // What an allocator says before it gives up helps nobody.
  if (!WIFEXITED(status))
    throw Error(ExitCode::bad_input,
                fmt::format("{}: damaged: OpenVDB ends at it with signal {}", file.string(), WTERMSIG(status)));
  std::cerr << words;
  return WEXITSTATUS(status);
}

}  // namespace volgi::app
