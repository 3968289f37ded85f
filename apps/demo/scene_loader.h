#pragma once
#include <chrono>
#include <filesystem>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/demo/document.h"

namespace volgi::demo {

/// Reads scenes on a thread of its own while the old one is still shown. One at a time: a newer request waits for the
/// one under way, whose scene is then dropped.
class SceneLoader {
 public:
  ~SceneLoader();
  void start(std::vector<std::filesystem::path> files, const app::LightOptions& light, double time_s = 0.0,
             const SceneReading& reading = {});
  bool busy() const { return running_.valid(); }
  /// Since start() [s]; 0 when not busy.
  double seconds() const;
  /// What is being read, of the newest request.
  const std::vector<std::filesystem::path>& files() const { return next_ ? next_->files : current_.files; }
  /// Their names.
  std::string title() const;

  /// What has come of the last request: nothing yet, a document, or why there is none.
  struct Result {
    std::unique_ptr<Document> document;
    std::string error;
    int exit_code = 0;
  };
  /// Empty as long as it is under way.
  std::optional<Result> take();
  /// Waits for it.
  Result wait();

 private:
  struct Request {
    std::vector<std::filesystem::path> files;
    app::LightOptions light;
    double time_s = 0.0;
    SceneReading reading = {};
  };
  void launch(Request request);

  Request current_;
  std::optional<Request> next_;
  std::future<Result> running_;
  std::chrono::steady_clock::time_point started_;
};

}  // namespace volgi::demo
