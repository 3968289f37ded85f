#pragma once
#include "core/gl/objects.h"
#include "core/gl/pass_timer.h"
#include "core/gl/program.h"
#include "core/gl/scene_buffers.h"
#include "screen/base/named_texture.h"
#include "screen/visibility/area_maps/virtual_area_lights.h"

namespace volgi::screen {

/// Pass "screen/visibility/area_maps/paraboloid_depth_maps": what every virtual area light sees of the scene, in one
/// layer each. All layers are made together, from triangles by a compute shader that meets each texel's own ray with
/// the triangle's plane: a paraboloid bends edges, and a rasterizer's straight ones would tear large triangles and
/// those that cross the rim. Surfaces whose plane passes through the area light, as its own does, are not seen. Alpha:
/// MASK and BLEND (hashed) as in raster passes. Large triangles are listed by tiles of 16 x 16 texels, and what a
/// tile has is drawn at once. Deterministic. Cost: triangles times layers, and texels covered.
class ParaboloidDepthMaps {
 public:
  static constexpr const char* name = "screen/visibility/area_maps/paraboloid_depth_maps";
  /// @param resolution texels on each side of a layer, up to 4096.
  ParaboloidDepthMaps(int resolution, int layers);

  void run(const gl::SceneBuffers& scene, const VirtualAreaLights& lights, gl::PassTimer& timer);
  /// The same from shared::VirtualAreaLight x count; layers beyond are empty.
  void run(const gl::SceneBuffers& scene, const gl::Buffer& area_lights, int count, gl::PassTimer& timer);

  int resolution() const { return resolution_; }
  int layers() const { return layers_; }
  /// R32F, 2D array: distance [m] from the area light along the texel's direction; infinity where there is nothing and
  /// outside the disk. Texel (x, y) of a layer is the disk's point ((x, y) + 0.5) * 2 / resolution - 1.
  const gl::Texture& distance() const { return distance_; }
  size_t bytes() const;
  void list_textures(std::vector<NamedTexture>& list) const { list_texture(list, name, "distance", distance_); }

 private:
  struct Programs {
    gl::Program triangles, tiles;
  };
  void draw(const Programs& programs, const gl::SceneBuffers::Triangles& triangles, int layers) const;
  void draw_layers(const Programs& programs, GLsizei triangles, int first, int layers) const;

  int resolution_, layers_;
  gl::Texture distance_;
  gl::Buffer tiles_;      // of large triangles: TileListHead, then uvec2 each
  gl::Buffer tile_ends_;  // of every tile, its last entry among them
  Programs opaque_, alpha_;
};

}  // namespace volgi::screen
