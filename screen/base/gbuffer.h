#pragma once
#include <glm/glm.hpp>

#include "core/camera.h"
#include "core/gl/objects.h"
#include "core/gl/pass_timer.h"
#include "core/gl/program.h"
#include "core/gl/scene_buffers.h"

namespace volgi::screen {

/// Pass "screen/base/gbuffer": what the camera sees at the centre of each pixel. Texel (0,0) is the bottom left one.
/// Cost: one draw of the scene.
class GBuffer {
 public:
  static constexpr const char* name = "screen/base/gbuffer";
  /// @param normal_format  of normals(); RGBA32F, twice as large, where this GPU cannot render to it: GL does not
  /// require that of signed normalised formats.
  explicit GBuffer(glm::ivec2 size, GLenum normal_format = GL_RGBA16_SNORM);
  void run(const gl::SceneBuffers& scene, const Camera& camera, gl::PassTimer& timer);

  glm::ivec2 size() const { return size_; }
  /// Positions, normals and albedo, for shaders with screen/base/gbuffer.glsl.
  void bind() const;
  size_t bytes() const { return (4 + 16 + 8 + 8 + 16 + 4) * size_t(size_.x) * size_t(size_.y); }
  const gl::Texture& depth() const { return depth_; }        // D32F, 1 at znear, 0 at zfar and in the background
  const gl::Texture& position() const { return position_; }  // RGBA32F, centred frame; w = 1, or 0 in the background
  const gl::Texture& normals() const {
    return normals_;
  }                                                            // normal_format: octahedral shading (xy), geometric (zw)
                                                               // normal, both on the viewer's side of the triangle
  const gl::Texture& albedo() const { return albedo_; }        // RGBA16, linear
  const gl::Texture& emission() const { return emission_; }    // RGBA32F, radiance towards the viewer
  const gl::Texture& object_id() const { return object_id_; }  // R32UI, Mesh::object_id; 0 in the background

 private:
  glm::ivec2 size_;
  gl::Texture depth_, position_, normals_, albedo_, emission_, object_id_;
  gl::Framebuffer framebuffer_;
  gl::Program program_;
};

}  // namespace volgi::screen
