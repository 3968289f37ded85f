#include "apps/volgi/failure.h"

#include <unistd.h>

#include <cstdio>
#include <exception>
#include <iostream>
#include <new>

#include "core/error.h"

namespace volgi::app {

int say_failure() {
  try {
    throw;
  } catch (const Error& e) {
    std::cerr << "volgi: " << e.what() << '\n';
    return int(e.code());
  } catch (const std::bad_alloc&) {
    std::cerr << "volgi: out of memory; try a smaller --grid or --size\n";
    return int(ExitCode::over_limit);
  } catch (const std::exception& e) {
    std::cerr << "volgi: " << e.what() << '\n';
    return int(ExitCode::bad_input);
  }
}

namespace {

std::terminate_handler otherwise = nullptr;

void end_program() {
  try {
    if (std::current_exception()) throw;
  } catch (const std::bad_alloc&) {
    _exit(say_failure());
  } catch (...) {
  }
  otherwise();
}

}  // namespace

void end_well_without_memory() { otherwise = std::set_terminate(end_program); }

int with_output_written(int code) {
  std::cout.flush();
  const bool written = std::cout.good() && std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
  if (written || code != int(ExitCode::done)) return code;
  std::cerr << "volgi: cannot write to the standard output\n";
  return int(ExitCode::cannot_write);
}

}  // namespace volgi::app
