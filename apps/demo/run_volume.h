#pragma once
#include "apps/demo/demo_options.h"

namespace volgi::demo {

/// Whether the command line names a volume (.vdb). @throws Error(usage) where it names something else beside it.
bool is_volume(const DemoOptions& options);

/// A window on a volume, or a picture of it (--headless), which needs neither display nor OpenGL. @returns an exit
/// code.
int run_volume(const DemoOptions& options);

}  // namespace volgi::demo
