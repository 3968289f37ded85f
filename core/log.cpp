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

void warn_once(std::string_view message) {
  static std::mutex mutex;
  static std::set<std::string, std::less<>> seen;
  const std::lock_guard lock(mutex);
  if (!seen.emplace(message).second || quiet) return;
  std::fprintf(stderr, "volgi: warning: %.*s\n", int(message.size()), message.data());
}

}  // namespace volgi
