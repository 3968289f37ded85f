#pragma once
#include "core/gl/objects.h"
#include "core/gl/pass_timer.h"
#include "core/gl/program.h"
#include "screen/base/gbuffer.h"
#include "screen/base/named_texture.h"
#include "screen/base/sky_seen.h"
#include "screen/sources/textured_area/area_lights.h"
#include "voxel/face_walk_gl.h"
#include "voxel/voxel_grid_gl.h"

namespace volgi::screen {

struct GlossyOptions {
  int rays = 2;        // of a pixel; 0: mirrors reflect as if light were even
  int interleave = 8;  // pixels of a block of n x n share rays and lights: 1, 2, 4 or 8
  float least_roughness = 0.25f;
};

/// Passes "screen/bounces/glossy/lobe_rays" and "screen/bounces/glossy/join_lobes": what mirrors of facets (glTF's GGX)
/// reflect at pixels whose albedo leaves it out (GBuffer::set_mirror_apart): rays through the lobe, by visible normals,
/// meet sides of the volume, whose radiosity they take, or the sky; what emits is found by virtual lights on it as
/// well, so that neither small lamps nor large screens are noise. Lobes narrower than options.least_roughness take that
/// one: cells would show.
/// Source: Nichols 2010, §5.3.2.1, takes 5 x 5 samples of the light's texture inside a narrow lobe, and virtual lights
/// for wide ones; we depart: all samples lie by the lobe itself, both kinds count by the balance heuristic, blocked
/// faces hide what is behind them, and surfaces that are no lights are seen too. Pixels of a block share rays and
/// lights. Cost: rays and lights / interleave^2 for each such pixel, a walk through cells each.
class LobeRays {
 public:
  static constexpr const char* name = "screen/bounces/glossy/lobe_rays";
  static constexpr const char* join_name = "screen/bounces/glossy/join_lobes";
  /// @param phong  has_phong_lobes().
  LobeRays(glm::ivec2 size, const GlossyOptions& options, bool phong);

  struct Seen {
    const VoxelGridGl& voxels;
    const gl::Buffer& radiosity;  // SideRadiosity
    const AreaLights* lights;     // null: none
    const SkySeen* sky;           // null: none
    float sky_rotation_rad;
  };
  /// @param gbuffer  that shines. @param sample  FrameData::sample: other rays.
  void run(const GBuffer& gbuffer, const Camera& camera, const Seen& seen, gl::PassTimer& timer, int sample = 0);

  /// The voxels of the next run are others.
  void scene_moved() { cells_.forget(); }

  const gl::Texture& direct() const { return direct_; }      // RGBA32F: emission and sky [W m^-2 sr^-1]
  const gl::Texture& indirect() const { return indirect_; }  // RGBA32F: what surfaces reflect
  /// Shares of the picture's pixels: with a mirror apart, and of these with a lobe that was widened. Both wait.
  struct Shares {
    double glossy, widened;
  };
  Shares shares() const;
  size_t bytes() const { return 4 * 16 * size_t(size_.x) * size_t(size_.y) + counts_.bytes() + light_sides_.bytes(); }
  void list_textures(std::vector<NamedTexture>& list) const {
    list_texture(list, join_name, "direct", direct_);
    list_texture(list, join_name, "indirect", indirect_);
  }

 private:
  void find_lights(const Seen& seen);
  void trace(const Camera& camera, const Seen& seen, int sample);
  void join();

  glm::ivec2 size_;
  GlossyOptions options_;
  gl::Texture direct_, indirect_, half_direct_, half_indirect_;
  gl::Buffer counts_, light_sides_, no_lights_;
  FaceWalkCells cells_;
  gl::Program light_sides_program_, rays_, join_;
};

}  // namespace volgi::screen
