#pragma once
#include "core/camera.h"
#include "core/gl/objects.h"
#include "core/gl/pass_timer.h"
#include "core/gl/program.h"
#include "propagation/radiance_volume_gl.h"

namespace volgi::screen {

/// Pass "screen/views/lobe_view": the radiance of one cell over a picture, as a surface around the cell's centre: in
/// the direction that light travels, as far away as there is radiance (luminance), in its colour; magenta where
/// spherical harmonics are negative. And the cell's edges. Where the root of the mean square is radius_cells away, no
/// point is farther than twice (four coefficients) or three times (nine) as much. Cost: 12 thousand vertices of four or
/// nine texels.
class LobeView {
 public:
  static constexpr const char* name = "screen/views/lobe_view";
  struct Options {
    glm::ivec3 cell{0};  // nearest that there is
    float exposure_ev = 0.0f;
    float radius_cells = 0.4f;
  };
  LobeView();
  /// @param radiance  as FrameVolume::radiance(). @param camera  of the picture. @param target  with the depth that
  /// hides the lobe (ViewTarget::begin_overlays).
  void run(const RadianceVolumeGl& radiance, const Camera& camera, const Options& options,
           const gl::Framebuffer& target, gl::PassTimer& timer);

 private:
  gl::Program lobe_, cube_;
};

/// The cell that a position lies in, or the nearest to it. Of a place on a surface, half a cell in front of it is the
/// one that shines on it.
glm::ivec3 nearest_cell(const Grid& grid, glm::vec3 position);

}  // namespace volgi::screen
