#pragma once
#include <glm/glm.hpp>
#include <string>

namespace volgi {

/// Looks along -Z of its own frame, +Y up (glTF). The aspect is the picture's, never the camera's.
struct Camera {
  enum class Kind { perspective, orthographic };
  std::string name;
  Kind kind = Kind::perspective;
  float yfov_rad = 0.7f;              // perspective
  float ymag = 1.0f;                  // orthographic: half the height of the view [m]
  float znear = 0.05f;                // [m]
  float zfar = 1000.0f;               // [m]; glTF's infinite far plane becomes a finite one around the scene's bounds
  glm::mat4 world_from_camera{1.0f};  // in the scene's centred frame (Scene::world_origin)
};

/// World-space ray through the picture position (x,y) in pixels, (0,0) the top left corner; the centre of the first
/// pixel is (0.5, 0.5). `direction` has length 1. For an orthographic camera the origin moves and the direction does
/// not.
struct CameraRay {
  glm::vec3 origin;
  glm::vec3 direction;
};
CameraRay camera_ray(const Camera& camera, glm::vec2 pixel_position, glm::ivec2 size);

/// Reversed-Z clip matrix (depth 1 at znear, 0 at zfar, GL_ZERO_TO_ONE); y up in clip space.
glm::mat4 clip_from_camera(const Camera& camera, glm::ivec2 size);
glm::mat4 camera_from_world(const Camera& camera);

/// Camera from --eye, --target, --yfov, near and far fitted to the bounds.
Camera look_at_camera(glm::vec3 eye, glm::vec3 target, float yfov_rad, glm::vec3 bounds_min, glm::vec3 bounds_max);
/// A camera that sees the whole box, for files that have none.
Camera framing_camera(glm::vec3 bounds_min, glm::vec3 bounds_max);

}  // namespace volgi
