#pragma once
#include "core/camera.h"
#include "core/gl/program.h"

namespace volgi::screen {

/// The uniforms of shaders/screen/views/view_camera.glsl.
inline void set_view_camera(const gl::Program& program, const Camera& camera, glm::ivec2 size) {
  const glm::mat4 clip = clip_from_camera(camera, size);
  const bool perspective = camera.kind == Camera::Kind::perspective;
  program.set("clip_from_world", clip * camera_from_world(camera));
  program.set("viewer", perspective ? camera.world_from_camera[3] : camera.world_from_camera[2]);
  program.set("picture_size", glm::vec2(size));
  program.set("pixel_at_1_m", 2.0f / (clip[1][1] * float(size.y)));
}

}  // namespace volgi::screen
