#pragma once
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "core/camera.h"
#include "core/gl/objects.h"
#include "core/gl/pass_timer.h"
#include "core/gl/program.h"
#include "core/gl/scene_buffers.h"
#include "screen/base/named_texture.h"

namespace volgi::screen {

/// Where a stage adds what mirrors of facets reflect (LightShare::mirror).
struct MirrorApart {
  float least = 0.1f;  // of even light that one reflects to the viewer: below it albedo() has it, at twice it nothing
};

/// Pass "screen/base/gbuffer": what the camera sees at the centre of each pixel. Texel (0,0) is the bottom left one.
/// Cost: one draw of the scene.
class GBuffer {
 public:
  static constexpr const char* name = "screen/base/gbuffer";
  /// @param normal_format  of normals(); RGBA32F, twice as large, where this GPU cannot render to it: GL does not
  /// require that of signed normalised formats.
  /// @param shines  some material is not Lambertian: diffuse() and mirror() are there.
  /// @param phong  has_phong_lobes() of the scene.
  explicit GBuffer(glm::ivec2 size, GLenum normal_format = GL_RGBA16_SNORM, bool shines = false, bool phong = false);
  void run(const gl::SceneBuffers& scene, const Camera& camera, gl::PassTimer& timer);

  /// Where in its pixel every sample lies, from the centre. [pixels]
  void set_jitter(glm::vec2 from_centre) { jitter_ = from_centre; }

  /// From which reflectance towards the viewer on a pixel's mirror leaves albedo(); none: it is all there.
  void set_mirror_apart(std::optional<float> least) { mirror_apart_ = least; }

  glm::ivec2 size() const { return size_; }
  const glm::mat4& clip_from_world() const { return clip_from_world_; }  // of the last run()
  /// Positions, normals and albedo, for shaders with screen/base/gbuffer.glsl.
  void bind() const;
  /// Those of surfaces that shine, beside them.
  void bind_shine() const;
  bool shines() const { return shines_; }
  bool phong() const { return phong_; }
  size_t bytes() const { return (4 + 16 + 8 + 8 + 16 + 4 + (shines_ ? 16 : 0)) * size_t(size_.x) * size_t(size_.y); }
  const gl::Texture& depth() const { return depth_; }        // D32F, 1 at znear, 0 at zfar and in the background
  const gl::Texture& position() const { return position_; }  // RGBA32F, centred frame; w = 1, or 0 in the background
  const gl::Texture& normals() const {
    return normals_;
  }  // normal_format: octahedral shading (xy), geometric (zw)
     // normal, both on the viewer's side of the triangle
  // RGBA16, linear: of even light, what goes to the viewer; alpha: the share of the mirror's part that is in it
  const gl::Texture& albedo() const { return albedo_; }
  const gl::Texture& diffuse() const { return diffuse_; }    // RGBA16: shared::Reflectance, and perceptual roughness
  const gl::Texture& mirror() const { return mirror_; }      // RGBA16: reflectance from in front, at grazing angles
  const gl::Texture& emission() const { return emission_; }  // RGBA32F, radiance towards the viewer
  void list_textures(std::vector<NamedTexture>& list) const;
  const gl::Texture& object_id() const { return object_id_; }  // R32UI, Mesh::object_id; 0 in the background

 private:
  glm::ivec2 size_;
  bool shines_, phong_;
  glm::vec2 jitter_{0.0f};
  glm::mat4 clip_from_world_{1.0f};
  std::optional<float> mirror_apart_;
  gl::Texture depth_, position_, normals_, albedo_, emission_, object_id_, diffuse_, mirror_, directional_albedo_;
  gl::Framebuffer framebuffer_;
  gl::Program program_;
};

}  // namespace volgi::screen
