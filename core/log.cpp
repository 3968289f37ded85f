#include "core/log.h"

#include <atomic>
#include <cstdio>
#include <mutex>
#include <set>
#include <string>

namespace volgi {
namespace {
std::atomic<bool> quiet{false};
}

void set_quiet(bool on) { quiet = on; }
bool is_quiet() { return quiet; }

namespace {
void warn(std::string_view message, bool shown) {
  static std::mutex mutex;
  static std::set<std::string, std::less<>> seen;
  const std::lock_guard lock(mutex);
  if (!seen.emplace(message).second || !shown) return;
  std::fprintf(stderr, "volgi: warning: %.*s\n", int(message.size()), message.data());
}
}  // namespace

void warn_once(std::string_view message) { warn(message, !quiet); }
void warn_of_wrong_result(std::string_view message) { warn(message, true); }

}  // namespace volgi
