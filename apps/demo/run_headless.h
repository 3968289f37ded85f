#pragma once
#include "apps/demo/demo_options.h"

namespace volgi::demo {

/// A picture of a view, pictures along a path, or a benchmark, without a window. @returns an exit code.
int run_headless(const DemoOptions& options);

}  // namespace volgi::demo
