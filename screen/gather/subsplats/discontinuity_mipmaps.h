#pragma once
#include "core/camera.h"
#include "core/gl/objects.h"
#include "core/gl/pass_timer.h"
#include "core/gl/program.h"
#include "screen/base/gbuffer.h"
#include "screen/base/named_texture.h"
#include "screen/gather/subsplats/subsplat_levels.h"

namespace volgi::screen {

struct DiscontinuityOptions {
  /// What makes a square discontinuous; the first four are those of the thesis' figure 3.7.
  enum class Criterion {
    depth_normal,
    derivative_normal,
    depth_curvature,
    derivative_curvature,
    depth,
    normal,
    derivative,
    curvature
  } criterion = Criterion::depth_normal;
  float depth = 0.05f;      // range of depth in a square, of the scene's diagonal
  float derivative = 4.0f;  // of depth, in diagonals over the height of the picture
  float normal = 0.2f;      // range of a component of the normal, 0 ... 2
  float curvature = 0.1f;   // between neighbours, 0 ... 2
  bool diagonals = true;    // squares diagonal to it are looked at as well (§3.4.2)
  bool borders = true;      // mipmaps take in the squares beside a square, on all of its sides (§3.4.2)
};

/// Pass "screen/gather/subsplats/discontinuity_mipmaps": for squares of 2, 4, 8 ... pixels on a side the least and most
/// depth and components of normals, and the most depth derivative and curvature (Nichols 2010, §3.2.2, eq. 3.1), and
/// from these whether it shows a discontinuity. Only what the criterion asks for is made. We depart: surface beside
/// background is a discontinuity whatever the criterion; thresholds are in parts of the scene, so that they hold at any
/// scale and size. Cost: a look at every pixel and 4 / 3 texels for every 2 x 2 of them; with `borders` four times
/// that.
class DiscontinuityMipmaps {
 public:
  static constexpr const char* name = "screen/gather/subsplats/discontinuity_mipmaps";
  DiscontinuityMipmaps(const SubsplatLevels& levels, const DiscontinuityOptions& options);

  void run(const GBuffer& gbuffer, const Camera& camera, float scene_diagonal_m, gl::PassTimer& timer);
  /// What shaders/screen/gather/subsplats/refined.glsl reads, in `program`. The G-buffer is bound elsewhere.
  void bind(const gl::Program& program) const;

  const gl::Texture& depth_ranges() const { return depth_ranges_; }  // RG32F, in the tower [m]
  const gl::Texture& least_normals() const { return least_normals_; }
  const gl::Texture& most_normals() const { return most_normals_; }
  const gl::Texture& bends() const { return bends_; }                      // RG32F: derivative [m a pixel], curvature
  const gl::Texture& discontinuities() const { return discontinuities_; }  // R8UI: SUBSPLAT_*
  size_t bytes() const;
  void list_textures(std::vector<NamedTexture>& list) const;

 private:
  void set_thresholds(const gl::Program& program, const Camera& camera, float scene_diagonal_m) const;

  SubsplatLevels levels_;
  DiscontinuityOptions options_;
  bool with_depth_, with_normals_, with_derivative_, with_curvature_;
  gl::Texture depth_ranges_, least_normals_, most_normals_, bends_, discontinuities_;
  gl::Program from_pixels_, from_level_;
};

}  // namespace volgi::screen
