#pragma once
#include <array>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "core/gl/objects.h"
#include "core/gl/pass_timer.h"
#include "core/gl/program.h"
#include "core/gl/scene_buffers.h"
#include "core/light_layers.h"
#include "core/scene.h"
#include "screen/base/glass.h"
#include "screen/base/named_texture.h"
#include "shaders/shared/reflective_shadow_map.shared.h"

namespace volgi::screen {

/// Pass "screen/base/reflective_shadow_map": what every punctual light sees. Read it in shaders through
/// shared/reflective_shadow_map.glsl after bind().
/// Cost: one draw of the scene per layer (1 for a sun or a spot, 6 for a point light or a spot wider than 60 degrees
/// from its axis); 16 bytes of GPU memory a texel, 24 where there is glass. What glass in front does to a texel's light
/// is in its albedo; points in front of the texel's surface look it up in tint().
class ReflectiveShadowMap {
 public:
  static constexpr const char* name = "screen/base/reflective_shadow_map";
  struct Resolution {  // texels on each side of a layer, more than 2 RSM_MARGIN_TEXELS
    int spot = 1024;
    int cube_face = 512;
    int sun = 2048;
  };
  /// @param normal_format  RG32F, which is 4 bytes a texel more, where this GPU cannot render to it.
  explicit ReflectiveShadowMap(Resolution resolution, GLenum normal_format = GL_RG16_SNORM);
  ReflectiveShadowMap() : ReflectiveShadowMap(Resolution()) {}

  /// Draws the maps of all of `scene.lights` (`buffers` must hold the triangles of `scene`). Textures are kept between
  /// frames while the lights keep their kinds.
  void run(const gl::SceneBuffers& buffers, const Scene& scene, gl::PassTimer& timer);

  int light_count() const { return int(lights_.size()); }
  int layer_count(int light) const { return lights_[size_t(light)].layer_count; }
  int resolution(int light) const { return lights_[size_t(light)].resolution; }
  /// The data of all lights, and the textures of `light` (shaders/shared/reflective_shadow_map.shared.h).
  void bind(int light) const;
  size_t bytes() const;  // GPU memory
  void list_textures(std::vector<NamedTexture>& list) const;

  const gl::Texture& depth(int light) const { return maps_[size_t(light)].depth; }    // D32F, 0 in the background
  const gl::Texture& normal(int light) const { return maps_[size_t(light)].normal; }  // normal_format, octahedral
  const gl::Texture& albedo(int light) const { return maps_[size_t(light)].albedo; }  // RGBA16
  const gl::Texture& tint(int light) const { return maps_[size_t(light)].tint; }      // RGBA16F, of scenes with glass
  const std::vector<shared::ReflectiveShadowLight>& lights() const { return lights_; }
  const std::vector<shared::ReflectiveShadowLayer>& layers() const { return layers_; }

 private:
  struct Map {
    gl::Texture depth, normal, albedo, tint;
    std::vector<gl::Framebuffer> framebuffers, through_glass;  // one per layer
  };
  Map make_map(int resolution, int layer_count) const;
  void draw_glass(const gl::SceneBuffers& buffers);
  void draw_layer(const gl::SceneBuffers& buffers, const Map& map, int light, int layer);

  Resolution resolution_;
  GLenum normal_format_;
  std::vector<shared::ReflectiveShadowLight> lights_;
  std::vector<shared::ReflectiveShadowLayer> layers_;
  std::vector<Map> maps_;
  gl::Buffer light_buffer_, layer_buffer_;
  gl::Program program_;
  std::optional<Glass> glass_;  // where there is some
};

}  // namespace volgi::screen
