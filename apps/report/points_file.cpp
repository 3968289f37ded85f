#include "apps/report/points_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>

#include "core/error.h"

namespace volgi::app {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path) {
  throw Error(ExitCode::cannot_write, fmt::format("cannot write {}: {}", path.string(), std::strerror(errno)));
}

bool ends_inside_a_line(int file) {
  char last = '\n';
  const off_t size = lseek(file, 0, SEEK_END);
  return size > 0 && pread(file, &last, 1, size - 1) == 1 && last != '\n';
}

// One write() of an O_APPEND file is one piece on a disk of one's own. The lock is for network file systems, where it
// is not, and for the line that somebody may have left incomplete.
void append_line(const std::filesystem::path& path, std::string line) {
  const int file = open(path.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (file < 0) fail(path);
  while (flock(file, LOCK_EX) != 0 && errno == EINTR) {
  }
  if (!line.empty() && ends_inside_a_line(file)) line.insert(0, "\n");
  const bool whole = write(file, line.data(), line.size()) == ssize_t(line.size()) && fsync(file) == 0;
  const int error = errno;
  close(file);
  errno = error;
  if (!whole) fail(path);
}

}  // namespace

PointsFile::PointsFile(std::filesystem::path path) : path_(std::move(path)) {
  append_line(path_, "");
  refresh();
}

void PointsFile::refresh() {
  std::error_code error;
  if (std::filesystem::file_size(path_, error) == read_) return;
  std::ifstream file(path_, std::ios::binary);
  file.seekg(std::streamoff(read_));
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  for (size_t at = 0, end = text.find('\n'); end != std::string::npos; at = end + 1, end = text.find('\n', at)) {
    Json point = Json::parse(text.begin() + std::ptrdiff_t(at), text.begin() + std::ptrdiff_t(end), nullptr, false);
    if (point.is_object() && point.contains("key")) {
      last_[point["key"].get<std::string>()] = lines_.size();
      lines_.push_back(std::move(point));
    }
    read_ += end + 1 - at;
  }
}

const PointsFile::Json* PointsFile::find(const std::string& key) const {
  const auto at = last_.find(key);
  if (at == last_.end()) return nullptr;
  const Json& point = lines_[at->second];
  return point.contains("error") ? nullptr : &point;
}

const PointsFile::Json* PointsFile::find_after(size_t lines, const std::string& key) const {
  const auto at = last_.find(key);
  return at == last_.end() || at->second < lines ? nullptr : &lines_[at->second];
}

std::vector<PointsFile::Json> PointsFile::points() const {
  std::vector<Json> out;
  for (size_t i = 0; i < lines_.size(); ++i) {
    if (last_.at(lines_[i]["key"].get<std::string>()) == i) out.push_back(lines_[i]);
  }
  return out;
}

void PointsFile::append(const Json& point) {
  append_line(path_, point.dump() + "\n");
  refresh();
}

}  // namespace volgi::app
