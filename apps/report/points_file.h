#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace volgi::app {

/// Measured points, one JSON object a line. A line is appended whole and is on the disk when append() returns, also
/// where other processes append to the same file; one that was killed leaves at most one incomplete line, which is not
/// read and not continued.
class PointsFile {
 public:
  using Json = nlohmann::ordered_json;

  /// Reads what is there. @throws Error(cannot_write) if the file cannot be opened for appending.
  explicit PointsFile(std::filesystem::path path);

  /// Reads what others have appended since.
  void refresh();
  /// The last finished point of this key (a failed one is none), or null.
  const Json* find(const std::string& key) const;
  /// The last point of this key, failed or not, if it is none of the first `lines`; or null.
  const Json* find_after(size_t lines, const std::string& key) const;
  size_t lines() const { return lines_.size(); }
  /// All points in the order of their lines; of those with one key only the last.
  std::vector<Json> points() const;
  /// @throws Error(cannot_write) when the line could not be written whole.
  void append(const Json& point);

 private:
  std::filesystem::path path_;
  std::vector<Json> lines_;
  std::map<std::string, size_t> last_;  // of a key
  std::uint64_t read_ = 0;              // bytes of the file, up to the end of a line
};

}  // namespace volgi::app
