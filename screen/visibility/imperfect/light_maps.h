#pragma once
#include <memory>
#include <optional>

#include "screen/base/named_texture.h"
#include "screen/base/virtual_light_list_gl.h"
#include "screen/visibility/area_maps/paraboloid_depth_maps.h"
#include "screen/visibility/imperfect/imperfect_maps.h"
#include "screen/visibility/visibility_choice.h"

namespace volgi::screen {

/// A map for each virtual light (or for some of them, evenly spread in the list: the others light as if nothing were in
/// between), and passes that make them: imperfect ones, or regular ones of the scene's triangles. Lights of a lattice,
/// which send both ways, have two. Gathers read them through screen/visibility/imperfect/light_map_visibility.glsl.
class LightMaps {
 public:
  static constexpr const char* product_name = "maps of virtual lights";
  static constexpr const char* views_name = "screen/visibility/imperfect/map_views";
  /// @param maps  imperfect or regular.
  LightMaps(const Scene& scene, VisibilityChoice::Maps maps, const ImperfectMapOptions& options);

  void follow(const Scene& scene);
  /// @throws Error(over_limit) for more maps than this GPU's textures hold.
  void run(const gl::SceneBuffers& triangles, const VirtualLightListGl& lights, float scene_diagonal_m,
           gl::PassTimer& timer);
  /// Texture and uniforms of a program that includes light_map_visibility.glsl.
  void bind(const gl::Program& program) const;

  int mapped() const { return mapped_; }  // lights
  int maps() const { return mapped_ * sides_; }
  size_t bytes() const;
  void list_textures(std::vector<NamedTexture>& list) const;

 private:
  void lay_out(const VirtualLightListGl& lights);
  void make_views(const VirtualLightListGl& lights) const;
  const gl::Texture& distances() const { return regular_ ? regular_->distance() : distances_; }

  std::optional<ImperfectMaps> imperfect_;  // else regular
  std::unique_ptr<ParaboloidDepthMaps> regular_;
  int regular_count_, texels_;
  int lights_ = 0, mapped_ = 0, sides_ = 1, tiles_ = 1;
  gl::Texture distances_;  // of imperfect maps
  gl::Buffer views_;       // shared::VirtualAreaLight x maps()
  gl::Program views_program_;
};

}  // namespace volgi::screen
