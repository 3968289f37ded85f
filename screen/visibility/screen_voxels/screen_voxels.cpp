#include "screen/visibility/screen_voxels/screen_voxels.h"

#include <algorithm>
#include <string>

#include "core/error.h"
#include "core/gl/raster_state.h"
#include "shaders/screen/visibility/screen_voxels/slots.shared.h"
#include "shaders/shared/group_sizes.shared.h"

namespace volgi::screen {

ScreenVoxels::ScreenVoxels(const ScreenVoxelOptions& options) : options_(options) {
  const int b = options.bits;
  if (b != 128 && b != 256 && b != 512 && b != 1024)
    throw Error(ExitCode::usage, "voxels.bits: 128, 256, 512 or 1024, not " + std::to_string(b));
  voxels_ = gl::Texture::make_2d_array(GL_R32UI, options.texels, options.texels, 2 * b / 32);
  wide_along_rows_ = gl::Texture::make_2d_array(GL_R32UI, options.texels, options.texels, b / 32);
  framebuffer_ = gl::Framebuffer::without_attachments(glm::ivec2(options.texels));
  program_ = gl::Program::raster("screen/base/reflective_shadow_map.vert.glsl",
                                 "screen/visibility/screen_voxels/voxelize.frag.glsl");
  widen_ = gl::Program::compute("screen/visibility/screen_voxels/widen.comp.glsl");
}

void ScreenVoxels::run(const gl::SceneBuffers& buffers, const Scene& scene, const Camera& camera, glm::ivec2 picture,
                       gl::PassTimer& timer) {
  const auto scope = timer.scope(name);
  const glm::mat4 view = camera_from_world(camera);
  clip_from_world_ = clip_from_camera(camera, picture) * view;
  // Depth, along -z of the camera, of the scene's bounds.
  float nearest = 3e38f, farthest = 0.0f;
  for (int k = 0; k < 8; ++k) {
    const glm::vec3 corner((k & 1) != 0 ? scene.bounds_max.x : scene.bounds_min.x,
                           (k & 2) != 0 ? scene.bounds_max.y : scene.bounds_min.y,
                           (k & 4) != 0 ? scene.bounds_max.z : scene.bounds_min.z);
    const float depth = -(view * glm::vec4(corner, 1.0f)).z;
    nearest = std::min(nearest, depth);
    farthest = std::max(farthest, depth);
  }
  nearest = std::max(nearest, camera.znear);
  farthest = std::max(farthest, nearest * 1.001f);
  const float per_m = float(options_.bits) / (farthest - nearest);
  slice_from_world_ = {-view[0].z * per_m, -view[1].z * per_m, -view[2].z * per_m, (-view[3].z - nearest) * per_m};

  constexpr GLuint empty = 0;
  glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);  // the last frame may have written
  glClearTexImage(voxels_.id(), 0, GL_RED_INTEGER, GL_UNSIGNED_INT, &empty);
  gl::begin_geometry_pass();
  framebuffer_.bind();
  voxels_.bind_image(VOXEL_BITS_IMAGE, GL_READ_WRITE);
  program_.set("clip_from_world", clip_from_world_);
  program_.set("slice_from_world", slice_from_world_);
  buffers.draw(program_);
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
  widen({1, 0}, voxels_, 0, wide_along_rows_, 0);
  widen({0, 1}, wide_along_rows_, 0, voxels_, options_.bits / 32);
}

void ScreenVoxels::widen(glm::ivec2 axis, const gl::Texture& from, int from_layer, const gl::Texture& to,
                         int to_layer) const {
  from.bind(VOXEL_BITS_UNIT);
  to.bind_image(VOXEL_BITS_IMAGE, GL_WRITE_ONLY);
  widen_.set("axis", axis);
  widen_.set("from_layer", from_layer);
  widen_.set("to_layer", to_layer);
  widen_.use();
  gl::dispatch({options_.texels, options_.texels, options_.bits / 32}, {SQUARE_GROUP, SQUARE_GROUP, 1});
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
}

void ScreenVoxels::bind(const gl::Program& program) const {
  voxels_.bind(VOXEL_BITS_UNIT);
  program.set("voxel_clip_from_world", clip_from_world_);
  program.set("voxel_slice_from_world", slice_from_world_);
  program.set("voxel_steps", options_.steps);
  program.set("voxel_bias", options_.bias);
}

}  // namespace volgi::screen
