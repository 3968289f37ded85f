#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "core/gl/objects.h"
#include "core/gl/pass_timer.h"
#include "core/gl/program.h"
#include "core/gl/scene_buffers.h"
#include "core/scene.h"
#include "core/sky.h"
#include "screen/base/glass.h"
#include "screen/base/named_texture.h"
#include "shaders/shared/reflective_shadow_map.shared.h"

namespace volgi::screen {

struct SkyOptions {
  int parts = 256;
  /// Who carries the first reflection: the volume, from what its sides receive of every part, or virtual lights on
  /// surfaces. None: the volume where a recipe has one after a first bounce on the screen (prefer_sky_by_lights()).
  enum class First { volume, lights };
  std::optional<First> first;
  int map_texels = 128;
  float tolerance = 0.06f;  // as SmoothPixelOptions has it: 256 parts of the sky err by 1 % on average themselves
};

/// Pass "screen/sources/sky/sky_maps": the sky as lights that are far away (core/sky.h), each with a map of what it
/// sees of the scene: depth and normals, compared without bias as reflective shadow maps are. Where most of the scene
/// is bare ground each part has a second map, of what stands on it (detail_box()). Drawn anew only where sky, scene or
/// sample have changed. Cost then: one draw of the scene a map; 12 bytes of GPU memory a texel, 20 where there is
/// glass.
class SkyMaps {
 public:
  static constexpr const char* name = "screen/sources/sky/sky_maps";
  static constexpr const char* product_name = "maps of the sky";
  explicit SkyMaps(const SkyOptions& options);

  /// @param scene  has a sky. @param sample  FrameData::sample: parts that lie elsewhere, hence other maps.
  void run(const gl::SceneBuffers& buffers, const Scene& scene, gl::PassTimer& timer, int sample = 0);
  void scene_moved() { drawn_.reset(); }
  /// For programs with screen/sources/sky/sky_parts.glsl.
  void bind(const gl::Program& program) const;

  const std::vector<SkyLight>& parts() const { return parts_; }
  int part_count() const { return int(parts_.size()); }
  /// Grows whenever the maps change.
  int version() const { return version_; }
  size_t bytes() const;
  void list_textures(std::vector<NamedTexture>& list) const { list_texture(list, name, "depth", depth_); }

 private:
  void make_room();
  void draw_glass(const gl::SceneBuffers& buffers);
  void upload_parts();
  bool detailed() const { return layers_.size() > parts_.size(); }

  int resolution_;
  int parts_asked_;
  int version_ = 0;
  std::shared_ptr<const Sky> drawn_;
  int drawn_sample_ = 0;
  std::optional<SkyParts> sky_;  // of the last sky that was drawn
  std::vector<SkyLight> parts_;
  std::vector<shared::ReflectiveShadowLayer> layers_;  // of the parts, and again of the parts where there is detail
  gl::Texture depth_, surface_, tint_;
  std::vector<gl::Framebuffer> framebuffers_, through_glass_;
  gl::Buffer part_buffer_;
  gl::Texture part_texels_;  // a view of it
  gl::Program program_;
  std::optional<Glass> glass_;  // where there is some
};

}  // namespace volgi::screen
