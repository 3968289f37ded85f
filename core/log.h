#pragma once
#include <string_view>

namespace volgi {

/// Prints "volgi: warning: MESSAGE" on stderr, once for each distinct message in the life of the process.
void warn_once(std::string_view message);

/// The same for a result that is not right: quiet does not keep it back.
void warn_of_wrong_result(std::string_view message);

/// With quiet on, warn_once and Progress print nothing.
void set_quiet(bool quiet);
bool is_quiet();

/// Quiet for as long as it lives: what is done on the way to something else has no progress of its own.
class Quiet {
 public:
  Quiet() : before_(is_quiet()) { set_quiet(true); }
  ~Quiet() { set_quiet(before_); }
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;

 private:
  bool before_;
};

}  // namespace volgi
