#pragma once
#include <memory>

#include "core/gl/pass_timer.h"
#include "core/scene.h"
#include "propagation/volume_options.h"

namespace volgi::screen {

/// Reflected light of a scene in space, for a program that draws the scene by itself: update() after lights or geometry
/// have moved, then bind() for shaders that include shaders/screen/library/volume_light.glsl, which have the irradiance
/// of any point from it. Light straight from lamps is the program's own. Needs a current OpenGL 4.5 context that volgi
/// knows: gl::Context, of a program's own window gl::Context(OfWindow()).
/// Cost: what `volgi render --gi volume --backend gpu` has below "propagation", and one pass over the volume; 64 bytes
/// a cell, 144 where `conservative` has SchemeOptions::sh_order 2. Irradiance is that of spherical harmonics in cells,
/// softer than the command's, which reads sides: two bands hold 3/4 of what comes from a point straight overhead (a
/// floor under a lamp near the ceiling: 0.83 of the light), and over all normals together all of it.
class VolumeLight {
 public:
  /// @param scene  must outlive this; core/gltf need not know of it: triangles, materials and lights in code will do.
  /// @throws Error(usage) for options that make no sense, Error(over_limit) above options.memory_limit, and as
  ///   make_grid.
  explicit VolumeLight(const Scene& scene, const VolumeOptions& options = {});
  ~VolumeLight();
  VolumeLight(const VolumeLight&) = delete;
  VolumeLight& operator=(const VolumeLight&) = delete;

  /// Of the scene as it is now: lights may have changed in any way, meshes have moved.
  void update();
  /// For a GL program, in use or not: its volgi_* uniforms, and the volume at a texture unit. After update().
  /// @param program  GL's number of it. @param unit  0 to 15.
  void bind(unsigned program, unsigned unit) const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace volgi::screen
