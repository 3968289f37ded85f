#pragma once
#include <filesystem>
#include <optional>
#include <string_view>

#include "core/scene.h"

namespace volgi {

/// Where the scene of any time comes from: a glTF file, or geometry that the program makes itself, which is called
/// builtin:NAME (a file of such a name is ./builtin:NAME).
///
///     const SceneSource source("builtin:metaballs");
///     WorldBox box;                                      // around all frames: the volume's grid stands still
///     for (double t : times) box.add(source.bounds(t));
///     Scene scene = source.at(times[0], box);
///     for (double t : times) { source.move(scene, t, box); ... }
class SceneSource {
 public:
  static constexpr std::string_view kBuiltInPrefix = "builtin:";

  /// @throws Error(usage) for a built-in scene that does not exist, naming those that do; otherwise as SceneFile.
  explicit SceneSource(const std::filesystem::path& path, const SceneReading& reading = {});

  /// As SceneFile.
  Scene at(double time_s) const;
  Scene at(double time_s, const WorldBox& box) const;
  /// As SceneFile: `scene` came from this source.
  void move(Scene& scene, double time_s, const WorldBox& box) const;
  WorldBox bounds(double time_s) const;
  /// Around all triangles at 65 times from 0 to duration_s(): the box in which an animation is looked at.
  WorldBox whole_bounds() const;
  /// Whether time changes anything.
  bool animated() const;
  /// As SceneFile::last_key_s(); of what is built in, its period.
  double duration_s() const;

 private:
  struct BuiltIn;
  static const BuiltIn& built_in(std::string_view name);

  std::optional<SceneFile> file_;
  const BuiltIn* built_in_ = nullptr;  // where there is no file
};

}  // namespace volgi
