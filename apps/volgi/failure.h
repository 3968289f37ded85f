#pragma once

namespace volgi::app {

/// Says the exception that is being handled in one line on stderr.
/// @return its exit code (core/error.h).
int say_failure();

}  // namespace volgi::app
