#pragma once
#include "apps/demo/demo_options.h"

namespace volgi::demo {

/// Until the window is closed. @returns an exit code.
int run_window(const DemoOptions& options);

}  // namespace volgi::demo
