#include "apps/demo/scene_loader.h"

#include <new>
#include <utility>

#include "core/error.h"

namespace volgi::demo {

namespace {

SceneLoader::Result load(const std::vector<std::filesystem::path>& files, const app::LightOptions& light, double time_s,
                         const SceneReading& reading) {
  SceneLoader::Result result;
  try {
    result.document = std::make_unique<Document>(files, light, time_s, reading);
  } catch (const Error& error) {
    result.error = error.what();
    result.exit_code = int(error.code());
  } catch (const std::bad_alloc&) {
    result.error = files.back().string() + ": not enough memory to read it";
    result.exit_code = int(ExitCode::over_limit);
  } catch (const std::exception& error) {
    result.error = files.back().string() + ": " + error.what();
    result.exit_code = int(ExitCode::bad_input);
  }
  return result;
}

}  // namespace

SceneLoader::~SceneLoader() {
  if (running_.valid()) running_.wait();
}

void SceneLoader::start(std::vector<std::filesystem::path> files, const app::LightOptions& light, double time_s,
                        const SceneReading& reading) {
  Request request{std::move(files), light, time_s, reading};
  if (busy()) {
    next_ = std::move(request);
  } else {
    launch(std::move(request));
  }
}

void SceneLoader::launch(Request request) {
  current_ = std::move(request);
  started_ = std::chrono::steady_clock::now();
  running_ = std::async(std::launch::async, load, current_.files, current_.light, current_.time_s, current_.reading);
}

double SceneLoader::seconds() const {
  if (!busy()) return 0.0;
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - started_).count();
}

std::string SceneLoader::title() const {
  std::string names;
  for (const std::filesystem::path& file : files()) names += (names.empty() ? "" : " + ") + file.filename().string();
  return names;
}

std::optional<SceneLoader::Result> SceneLoader::take() {
  if (!busy() || running_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return std::nullopt;
  Result result = running_.get();
  if (!next_) return result;
  launch(*std::exchange(next_, std::nullopt));
  return std::nullopt;
}

SceneLoader::Result SceneLoader::wait() {
  while (true) {
    running_.wait();
    if (std::optional<Result> result = take()) return std::move(*result);
  }
}

}  // namespace volgi::demo
