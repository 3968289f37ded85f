#include "core/atomic_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <fstream>
#include <string>
#include <system_error>

#include "core/error.h"

namespace volgi {
namespace fs = std::filesystem;
namespace {

[[noreturn]] void fail(const fs::path& target, const std::string& why) {
  throw Error(ExitCode::cannot_write, fmt::format("cannot write {}: {}", target.string(), why));
}

/// Removes the temporary file unless it was renamed.
struct TemporaryFile {
  fs::path path;
  ~TemporaryFile() {
    std::error_code ignored;
    if (!path.empty()) fs::remove(path, ignored);
  }
};

fs::path temporary_name(const fs::path& target) {
  static std::atomic<unsigned> counter{0};  // two threads may write the same target, and two machines as well
  char host[256] = "";
  gethostname(host, sizeof host - 1);
  fs::path name = target.stem();
  name += fmt::format(".tmp-{}-{}-{}", host, getpid(), counter++);
  name += target.extension();
  return target.parent_path() / name;
}

}  // namespace

namespace {

void check_target(const fs::path& target) {
  std::error_code error;
  const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  if (target.filename().empty()) fail(target, "no file name given");
  if (!fs::is_directory(folder, error)) fail(target, fmt::format("there is no folder {}", folder.string()));
  if (access(folder.c_str(), W_OK | X_OK) != 0) {
    fail(target, fmt::format("the folder {} cannot be written", folder.string()));
  }
  // A rename would replace a device such as /dev/null by a file.
  const fs::file_status status = fs::status(target, error);
  if (fs::exists(status) && !fs::is_regular_file(status)) fail(target, "it exists and is not a regular file");
}

}  // namespace

void check_writable(const fs::path& target) {
  check_target(target);
  const TemporaryFile probe{temporary_name(target)};  // seen to be full or read-only only when written
  if (!std::ofstream(probe.path)) fail(target, "no permission or no space");
}

void write_atomically(const fs::path& target, const std::function<void(const fs::path&)>& write) {
  check_target(target);
  TemporaryFile temporary{temporary_name(target)};
  write(temporary.path);
  std::error_code error;
  fs::rename(temporary.path, target, error);
  if (error) fail(target, error.message());
  temporary.path.clear();
}

void write_text_atomically(const fs::path& target, std::string_view text) {
  write_atomically(target, [&](const fs::path& temporary) {
    std::ofstream file(temporary, std::ios::binary);
    file << text;
    file.close();
    if (!file) fail(target, "the disk may be full");
  });
}

}  // namespace volgi
