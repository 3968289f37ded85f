#pragma once
#include <filesystem>
#include <vector>

#include "apps/demo/camera_pose.h"

namespace volgi::demo {

/// Where the camera is at a time of the path, and which time the scene's animations have then.
struct CameraKey {
  double time_s = 0.0;
  CameraPose pose;
  double scene_time_s = 0.0;
};

/// How far a thinned path may be from the keys that it had.
struct PathTolerance {
  double position_m = 0.001;
  double angle_rad = 0.001;  // of the orientation, and of the vertical field of view
  double scene_time_s = 0.001;
};

/// A camera's way through a scene, recorded or made by hand. Times of keys rise; all keys are perspective, or all
/// orthographic.
class CameraPath {
 public:
  CameraPath() = default;
  /// @throws Error(bad_input) naming the key: times that do not rise, numbers that are not finite, a lens of another
  /// kind than the key before has.
  explicit CameraPath(std::vector<CameraKey> keys);

  const std::vector<CameraKey>& keys() const { return keys_; }
  bool empty() const { return keys_.empty(); }
  double first_time_s() const { return keys_.empty() ? 0.0 : keys_.front().time_s; }
  double last_time_s() const { return keys_.empty() ? 0.0 : keys_.back().time_s; }

  /// For recording: appends a key; one that is not later than the last takes its place.
  /// @throws Error(bad_input) as the constructor.
  void add(const CameraKey& key);

  /// The camera at a time, held before the first key and after the last; not of an empty path. Passes through the keys,
  /// with a speed and a turning rate that do not jump: cubic Hermite curves whose tangents are Catmull-Rom's for
  /// unevenly spaced times, so that steady motion stays steady. A tangent is no longer than three times the slower of
  /// its two neighbours, which keeps a camera that stands still from swinging back before it starts. Orientations run
  /// along Bezier curves of the sphere (Shoemake 1985, "Animating rotation with quaternion curves") with such tangents,
  /// and lean to no side between keys that do not. Field of view and ymag likewise, in their logarithms and never
  /// beyond those of both keys. The scene's time is linear between keys.
  CameraKey at(double time_s) const;

  /// The same times with less noise: positions, orientations and lenses are those of a straight line that is fitted
  /// around each key with weights exp(-½ (Δt/σ)²), σ = `seconds`, less near the ends, so that the first and the last
  /// key stay where they are and steady motion passes unchanged. Scene times stay. Cost: keys · keys within 3 σ.
  CameraPath smoothed(double seconds) const;

  /// Fewer keys of those that there are, so that at() is within `tolerance` of all of them at their times.
  CameraPath thinned(const PathTolerance& tolerance) const;

 private:
  void check_last() const;

  std::vector<CameraKey> keys_;
};

/// {"volgi_camera_path": 1, "keys": [{"time_s", "position" [x,y,z] in the file's world frame, "orientation" [x,y,z,w],
/// "yfov_rad" or "ymag_m", "scene_time_s" (without it time_s)}, ...]}.
/// @throws Error(bad_input) naming file and element, as CameraPath(), for a file without keys and for another version.
/// What is unknown is ignored, and said once.
CameraPath read_camera_path(const std::filesystem::path& file);
/// Atomically; the same path makes the same bytes, and reads back the same. @throws Error(cannot_write).
void write_camera_path(const std::filesystem::path& file, const CameraPath& path);

}  // namespace volgi::demo
