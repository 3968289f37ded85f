#pragma once
#include <CLI/CLI.hpp>

#include "core/gl/context.h"

namespace volgi::app {

/// Options of every command that needs OpenGL.
struct DeviceOptions {
  gl::ContextOptions context;

  void add_to(CLI::App& command) {
    command.add_option(
        "--device", context.device,
        "number of the EGL device (that of VOLGI_DEVICE, else the first hardware device, else software)");
    command.add_flag("--gl-debug", context.debug, "have OpenGL say what is wrong where it is wrong; may be slower");
  }
};

}  // namespace volgi::app
