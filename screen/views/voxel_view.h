#pragma once
#include "core/camera.h"
#include "core/gl/objects.h"
#include "core/gl/pass_timer.h"
#include "core/gl/program.h"
#include "screen/views/instances.h"
#include "shaders/screen/views/view_modes.shared.h"
#include "voxel/voxel_grid_gl.h"

namespace volgi::screen {

/// Pass "screen/views/voxel_view": the volume's sides over a picture, as squares on the faces of the cells that see
/// them, with darker rims. Those seen from behind are left out, so that one looks into a room from outside. Their
/// number stays on the GPU. Cost: a square of two triangles a side.
class VoxelView {
 public:
  static constexpr const char* name = "screen/views/voxel_view";
  enum class Mode {
    indirect = VIEW_SIDE_INDIRECT,      // irradiance over pi, as a white surface would show it
    direct = VIEW_SIDE_DIRECT,          // likewise
    irradiance = VIEW_SIDE_IRRADIANCE,  // their sum
    albedo = VIEW_SIDE_ALBEDO,          // sRGB encoded
    coverage = VIEW_SIDE_COVERAGE,      // viridis, 0 to 1
    normal = VIEW_SIDE_NORMAL,          // 0.5 + 0.5 n
    emission = VIEW_SIDE_EMISSION,      // radiance
  };
  struct Options {
    Mode mode = Mode::irradiance;
    float exposure_ev = 0.0f;  // of light, as Present's
  };
  VoxelView();
  /// @param direct, indirect  irradiance by side, vec4 [W m^-2], as FrameVolume has them; null: black.
  /// @param camera  of the picture. @param target  with the depth that hides sides (ViewTarget::begin_overlays).
  void run(const VoxelGridGl& voxels, const gl::Buffer* direct, const gl::Buffer* indirect, const Camera& camera,
           const Options& options, const gl::Framebuffer& target, gl::PassTimer& timer);

 private:
  gl::Program program_;
  Instances sides_;
  gl::Buffer command_;  // of an indirect draw
  gl::Buffer black_;
};

}  // namespace volgi::screen
