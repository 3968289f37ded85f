#include "core/claims.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <numeric>
#include <utility>
#include <vector>

#include "core/error.h"

namespace volgi {
namespace fs = std::filesystem;
namespace {

[[noreturn]] void fail(const fs::path& path) {
  throw Error(ExitCode::cannot_write, fmt::format("cannot share work through {}: {}", path.string(), strerror(errno)));
}

std::string text_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string first_word(const std::string& text) { return text.substr(0, text.find_first_of(" \n")); }

/// When a process began, in ticks since the machine did; empty where there is none, or only what is left of one.
std::string start_of(const std::string& process) {
  const std::string stat = text_of("/proc/" + process + "/stat");
  const size_t name_end = stat.rfind(')');  // a program's name may hold anything
  if (name_end == std::string::npos || name_end + 2 >= stat.size()) return "";
  const char state = stat[name_end + 2];
  size_t at = name_end + 2;
  for (int field = 3; field < 22 && at != std::string::npos; ++field) at = stat.find(' ', at + 1);
  return at == std::string::npos || state == 'Z' || state == 'X' ? "" : first_word(stat.substr(at + 1));
}

/// Where process numbers mean the same: one start of one machine, and one name space (containers have their own).
std::string place_of_processes() {
  std::error_code error;
  const fs::path names = fs::read_symlink("/proc/self/ns/pid", error);
  return first_word(text_of("/proc/sys/kernel/random/boot_id")) + "/" + (error ? "" : names.string());
}

struct Owner {
  std::string place, process, start;
};

Owner parse_owner(const std::string& text) {
  const size_t first = text.find(' '), second = first == std::string::npos ? first : text.find(' ', first + 1);
  if (second == std::string::npos) return {};
  return {text.substr(0, first), text.substr(first + 1, second - first - 1), first_word(text.substr(second + 1))};
}

/// For as long as it lives nobody else is in the folder's critical parts. Where the file system has no locks there is
/// none, and a piece may be taken over twice.
class Lock {
 public:
  explicit Lock(const fs::path& folder) : file_(open((folder / "lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666)) {
    while (file_ >= 0 && flock(file_, LOCK_EX) != 0 && errno == EINTR) {
    }
  }
  ~Lock() {
    if (file_ >= 0) close(file_);
  }
  Lock(const Lock&) = delete;
  Lock& operator=(const Lock&) = delete;

 private:
  int file_;
};

/// A file of our own in the folder, with our name in it.
struct OwnFile {
  fs::path path;
  OwnFile(const fs::path& folder, const std::string& self) {
    static std::atomic<unsigned> counter{0};
    char host[256] = "";
    gethostname(host, sizeof host - 1);
    path = folder / fmt::format(".{}-{}-{}", host, getpid(), counter++);
    const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (file < 0) fail(folder);
    const bool whole = write(file, self.data(), self.size()) == ssize_t(self.size()) && fsync(file) == 0;
    if (close(file) != 0 || !whole) fail(folder);
  }
  ~OwnFile() { unlink(path.c_str()); }
  OwnFile(const OwnFile&) = delete;
  OwnFile& operator=(const OwnFile&) = delete;
};

}  // namespace

Claims::Claim::Claim(Claim&& other) noexcept
    : claims_(std::exchange(other.claims_, nullptr)), name_(std::move(other.name_)) {}

Claims::Claim::~Claim() {
  if (claims_ != nullptr) claims_->give_back(name_);
}

Claims::Claims(fs::path folder, std::chrono::milliseconds silence) : folder_(std::move(folder)), silence_(silence) {
  std::error_code error;
  fs::create_directories(folder_, error);
  if (error) throw Error(ExitCode::cannot_write, folder_.string() + ": cannot make this folder: " + error.message());
  const std::string process = std::to_string(getpid());
  self_ = place_of_processes() + " " + process + " " + start_of(process) + "\n";
  const OwnFile probe(folder_, self_);  // says now what would fail later
  renewing_ = std::thread([this] { renew(); });
}

Claims::~Claims() {
  {
    const std::lock_guard guard(mutex_);
    ended_ = true;
  }
  wake_.notify_all();
  renewing_.join();
}

void Claims::renew() {
  std::unique_lock lock(mutex_);
  while (!wake_.wait_for(lock, silence_ / 6, [this] { return ended_; })) {
    // Not a claim that was taken from us while we slept.
    for (const std::string& name : held_) {
      if (text_of(file_of(name)) == self_) utimensat(AT_FDCWD, file_of(name).c_str(), nullptr, 0);
    }
  }
}

bool Claims::is_dead(const fs::path& own, const fs::path& claim, const std::string& text) const {
  const Owner owner = parse_owner(text), self = parse_owner(self_);
  if (owner.place == self.place && start_of(owner.process) != owner.start) return true;
  struct stat now {
  }, then{};
  utimensat(AT_FDCWD, own.c_str(), nullptr, 0);  // the file server's clock
  if (stat(own.c_str(), &now) != 0 || stat(claim.c_str(), &then) != 0) return false;
  const auto time = [](const timespec& t) {
    return std::chrono::seconds(t.tv_sec) + std::chrono::nanoseconds(t.tv_nsec);
  };
  return time(now.st_mtim) - time(then.st_mtim) > silence_;
}

bool Claims::take_over(const fs::path& own, const fs::path& claim, const std::string& seen) const {
  const Lock lock(folder_);
  return text_of(claim) == seen && is_dead(own, claim, seen) && rename(own.c_str(), claim.c_str()) == 0;
}

std::optional<Claims::Claim> Claims::take(const std::string& name) {
  const OwnFile own(folder_, self_);
  const fs::path claim = file_of(name);
  if (link(own.path.c_str(), claim.c_str()) != 0) {
    if (errno != EEXIST) fail(claim);
    const std::string owner = text_of(claim);
    if (owner == self_ || !is_dead(own.path, claim, owner) || !take_over(own.path, claim, owner)) return std::nullopt;
  }
  const std::lock_guard guard(mutex_);
  held_.insert(name);
  return Claim(*this, name);
}

void Claims::give_back(const std::string& name) {
  {
    const std::lock_guard guard(mutex_);
    held_.erase(name);
  }
  const Lock lock(folder_);
  if (text_of(file_of(name)) == self_) unlink(file_of(name).c_str());
}

namespace {
constexpr std::chrono::milliseconds kLook{200};  // between two looks at what others have done
}

Claims::Claim Claims::wait_for(const std::string& name) {
  for (;; std::this_thread::sleep_for(kLook)) {
    if (std::optional<Claim> claim = take(name)) return std::move(*claim);
  }
}

void Claims::work(int count, const std::function<std::string(int)>& name, const std::function<bool(int)>& is_done,
                  const std::function<void(int)>& piece) {
  std::vector<int> open(size_t(std::max(count, 0)));
  std::iota(open.begin(), open.end(), 0);
  for (bool did_one = true; !open.empty(); did_one = false) {
    const auto finished = [&](int k) {
      if (is_done(k)) return true;
      const std::optional<Claim> claim = take(name(k));
      if (!claim) return false;
      if (!is_done(k)) piece(k);
      return did_one = true;
    };
    std::erase_if(open, finished);
    if (!did_one && !open.empty()) std::this_thread::sleep_for(kLook);
  }
  // A worker may be killed when its piece is done and not yet given back.
  for (int k = 0; k < count; ++k) {
    std::error_code error;
    if (fs::exists(file_of(name(k)), error)) take(name(k));
  }
}

}  // namespace volgi
