#pragma once
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <optional>

#include "core/camera.h"
#include "core/scene.h"

namespace volgi::demo {

/// A camera as files keep it, apart from any scene at any time: in the file's world frame, where Camera is in the frame
/// that is centred on the scene. It has no depth range.
struct CameraPose {
  glm::dvec3 position{0.0};                    // file's world frame [m]
  glm::dquat orientation{1.0, 0.0, 0.0, 0.0};  // world from camera, unit; the camera looks along its -Z, +Y up
  double yfov_rad = 0.7;                       // perspective
  std::optional<double> ymag_m;  // orthographic: half the height of the view; the field of view is not used
};

CameraPose pose_of(const Camera& camera, const Scene& scene);
/// Its depth range is fitted to the scene's bounds (with_depth_of()).
Camera camera_of(const CameraPose& pose, const Scene& scene);

/// The same pose leaning to no side.
glm::dquat levelled(const glm::dquat& orientation);
/// Whether it leans by less than 1e-6.
bool is_level(const glm::dquat& orientation);

}  // namespace volgi::demo
