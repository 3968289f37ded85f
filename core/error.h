#pragma once
#include <stdexcept>
#include <string>

namespace volgi {

/// What the programs return to the shell (docs/conventions.md#exit-codes).
enum class ExitCode : int {
  done = 0,
  comparison_failed = 1,
  usage = 2,
  bad_input = 3,
  no_device = 4,
  over_limit = 5,
  cannot_write = 6,
};

/// A failure that the user's input or machine caused. The message is one line: what is wrong, in which file and
/// element, and what to do. Programming mistakes are assertions instead.
class Error : public std::runtime_error {
 public:
  Error(ExitCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  ExitCode code() const { return code_; }

 private:
  ExitCode code_;
};

}  // namespace volgi
