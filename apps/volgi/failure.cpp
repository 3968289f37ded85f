#include "apps/volgi/failure.h"

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

}  // namespace volgi::app
