#pragma once

namespace volgi::app {

/// Says the exception that is being handled in one line on stderr.
/// @return its exit code (core/error.h).
int say_failure();

/// From now on what runs out of memory where no exception can pass, as in destructors of OpenVDB's trees, ends the
/// program as it does elsewhere: one line, exit code 5 (over_limit), and not by abort().
void end_well_without_memory();

/// Of a command that has ended with `code`: that, or cannot_write, said, where its standard output could not be
/// written.
int with_output_written(int code);

}  // namespace volgi::app
