#pragma once

namespace volgi::app {

/// Says the exception that is being handled in one line on stderr.
/// @return its exit code (core/error.h).
int say_failure();

/// Of a command that has ended with `code`: that, or cannot_write, said, where its standard output could not be
/// written.
int with_output_written(int code);

}  // namespace volgi::app
