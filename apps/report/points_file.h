#pragma once
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace volgi::app {

/// Measured points, one JSON object a line. A line is appended whole and is on the disk when append() returns; a run
/// that was killed leaves at most one incomplete line, which is not read and not continued.
class PointsFile {
 public:
  using Json = nlohmann::ordered_json;

  /// Reads what is there. @throws Error(cannot_write) if the file cannot be opened for appending.
  explicit PointsFile(std::filesystem::path path);

  /// The last finished point of this key (a failed one is none), or null.
  const Json* find(const std::string& key) const;
  /// All points in the order of their lines; of those with one key only the last.
  std::vector<Json> points() const;
  /// @throws Error(cannot_write) when the line could not be written whole.
  const Json& append(Json point);

 private:
  std::filesystem::path path_;
  std::vector<Json> lines_;
  std::map<std::string, size_t> last_;  // of a key
  bool open_line_ = false;              // the file ends inside a line
};

}  // namespace volgi::app
