#pragma once
#include <chrono>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

namespace volgi::demo {

/// What happens in a window, a line of JSON each, for whoever watches it from outside: {"s": since the program began,
/// "event": name, ...}.
class EventLog {
 public:
  /// @param file  empty: nothing is written. @throws Error(cannot_write).
  explicit EventLog(const std::filesystem::path& file);
  void add(const std::string& event, nlohmann::json more = nlohmann::json::object());

 private:
  std::ofstream out_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace volgi::demo
