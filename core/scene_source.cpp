#include "core/scene_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>

#include "core/error.h"
#include "core/metaballs.h"

namespace volgi {

/// A scene whose bounds never change, because the room around what moves does not.
struct SceneSource::BuiltIn {
  std::string_view name;
  Scene (*at)(double time_s);
  void (*move)(Scene& scene, double time_s);
  WorldBox (*bounds)();
  double period_s;
};

const SceneSource::BuiltIn& SceneSource::built_in(std::string_view name) {
  static constexpr std::array known{
      BuiltIn{"metaballs", metaballs_scene, move_metaballs, metaballs_bounds, Metaballs::kPeriod_s}};
  const auto* found = std::find_if(known.begin(), known.end(), [&](const BuiltIn& b) { return b.name == name; });
  if (found != known.end()) return *found;
  std::string names;
  for (const BuiltIn& b : known) names += fmt::format(" {}{}", kBuiltInPrefix, b.name);
  throw Error(ExitCode::usage,
              fmt::format("{}{}: there is no such built-in scene; there are:{}", kBuiltInPrefix, name, names));
}

SceneSource::SceneSource(const std::filesystem::path& path, const SceneReading& reading) {
  const std::string name = path.string();
  if (name.starts_with(kBuiltInPrefix)) {
    built_in_ = &built_in(std::string_view(name).substr(kBuiltInPrefix.size()));
  } else {
    file_.emplace(path, reading);
  }
}

Scene SceneSource::at(double time_s) const { return file_ ? file_->at(time_s) : built_in_->at(time_s); }

Scene SceneSource::at(double time_s, const WorldBox& box) const {
  return file_ ? file_->at(time_s, box) : built_in_->at(time_s);
}

void SceneSource::move(Scene& scene, double time_s, const WorldBox& box) const {
  if (file_) {
    file_->move(scene, time_s, box);
  } else {
    built_in_->move(scene, time_s);
  }
}

WorldBox SceneSource::bounds(double time_s) const { return file_ ? file_->bounds(time_s) : built_in_->bounds(); }

double SceneSource::duration_s() const { return file_ ? file_->last_key_s() : built_in_->period_s; }

WorldBox SceneSource::whole_bounds() const {
  constexpr int STEPS = 64;
  WorldBox box = bounds(0.0);
  for (int k = 1; k <= STEPS && animated(); ++k) box.add(bounds(duration_s() * k / STEPS));
  return box;
}

bool SceneSource::animated() const { return !file_ || file_->animated(); }

Scene load_scene(const std::filesystem::path& path, double time_s, const SceneReading& reading) {
  return SceneSource(path, reading).at(time_s);
}

}  // namespace volgi
