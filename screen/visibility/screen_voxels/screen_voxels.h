#pragma once
#include "core/camera.h"
#include "core/gl/objects.h"
#include "core/gl/pass_timer.h"
#include "core/gl/program.h"
#include "core/gl/scene_buffers.h"
#include "core/scene.h"

namespace volgi::screen {

struct ScreenVoxelOptions {
  int texels = 128;   // on each edge of the picture: 32 ... 1024
  int bits = 128;     // slices in depth: 128, 256, 512 or 1024
  int steps = 64;     // at most, along a way
  float bias = 2.0f;  // voxels that a way leaves out at both ends
};

/// Pass "screen/visibility/screen_voxels": what the camera's frustum holds, a bit for each voxel: texels of the picture
/// by slices of equal depth, from the scene's nearest to its farthest point. Fragments are combined by logical OR, so
/// that their order does not matter; one that leans covers all slices between its corners.
/// Source: Nichols 2010, §5.3.3, after Eisemann and Decoret; we depart: atomic OR into the layers of one integer
/// texture instead of a logical operation of the blend stage, so that more than 128 slices need no more targets, and
/// fragments are as thick as they lean. What the camera does not see, beside or behind it, hides nothing.
/// Cost: a draw of the scene; 3 bits / 8 bytes a texel. A way: as many samples as it crosses voxels, at most `steps`,
/// or a quarter of that where nothing is near it: a second texture has what lies in 4 x 4 texels from each on.
class ScreenVoxels {
 public:
  static constexpr const char* name = "screen/visibility/screen_voxels";
  static constexpr const char* product_name = "screen-space voxels";
  /// @throws Error(usage) when bits is none of its values.
  explicit ScreenVoxels(const ScreenVoxelOptions& options);

  /// @param picture  in pixels, for its aspect.
  void run(const gl::SceneBuffers& buffers, const Scene& scene, const Camera& camera, glm::ivec2 picture,
           gl::PassTimer& timer);
  /// Textures and uniforms of shaders/screen/visibility/screen_voxels/screen_voxels.glsl.
  void bind(const gl::Program& program) const;

  int steps() const { return options_.steps; }
  const gl::Texture& bits() const { return voxels_; }  // R32UI, 32 slices a layer; then the wide ones
  size_t bytes() const { return 3 * size_t(options_.texels) * size_t(options_.texels) * size_t(options_.bits) / 8; }

 private:
  void widen(glm::ivec2 axis, const gl::Texture& from, int from_layer, const gl::Texture& to, int to_layer) const;

  ScreenVoxelOptions options_;
  gl::Texture voxels_, wide_along_rows_;
  gl::Framebuffer framebuffer_;
  gl::Program program_, widen_;
  glm::mat4 clip_from_world_{1.0f};
  glm::vec4 slice_from_world_{0.0f};  // dot(xyz, position) + w
};

}  // namespace volgi::screen
