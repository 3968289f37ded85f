#include "apps/report/points_file.h"

#include <fcntl.h>
#include <fmt/format.h>
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

// One write() of an O_APPEND file is one piece, whoever else appends.
void append_line(const std::filesystem::path& path, const std::string& line) {
  const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (file < 0) fail(path);
  const bool whole = write(file, line.data(), line.size()) == ssize_t(line.size()) && fsync(file) == 0;
  const int error = errno;
  close(file);
  errno = error;
  if (!whole) fail(path);
}

}  // namespace

PointsFile::PointsFile(std::filesystem::path path) : path_(std::move(path)) {
  append_line(path_, "");
  std::ifstream file(path_, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  for (size_t at = 0; at < text.size();) {
    const size_t end = text.find('\n', at);
    open_line_ = end == std::string::npos;
    if (open_line_) break;
    Json point = Json::parse(text.begin() + std::ptrdiff_t(at), text.begin() + std::ptrdiff_t(end), nullptr, false);
    if (point.is_object() && point.contains("key")) {
      last_[point["key"].get<std::string>()] = lines_.size();
      lines_.push_back(std::move(point));
    }
    at = end + 1;
  }
}

const PointsFile::Json* PointsFile::find(const std::string& key) const {
  const auto at = last_.find(key);
  if (at == last_.end()) return nullptr;
  const Json& point = lines_[at->second];
  return point.contains("error") ? nullptr : &point;
}

std::vector<PointsFile::Json> PointsFile::points() const {
  std::vector<Json> out;
  for (size_t i = 0; i < lines_.size(); ++i) {
    if (last_.at(lines_[i]["key"].get<std::string>()) == i) out.push_back(lines_[i]);
  }
  return out;
}

const PointsFile::Json& PointsFile::append(Json point) {
  append_line(path_, fmt::format("{}{}\n", open_line_ ? "\n" : "", point.dump()));
  open_line_ = false;
  last_[point.at("key").get<std::string>()] = lines_.size();
  lines_.push_back(std::move(point));
  return lines_.back();
}

}  // namespace volgi::app
