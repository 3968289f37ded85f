#pragma once
#include <memory>
#include <vector>

#include "core/camera.h"
#include "core/gl/objects.h"
#include "core/gl/pass_timer.h"
#include "core/gl/program.h"
#include "core/gl/scan.h"
#include "screen/base/gbuffer.h"
#include "screen/base/sum_in_order.h"
#include "screen/base/virtual_light_list_gl.h"
#include "shaders/screen/visibility/negative/negative_light.shared.h"
#include "voxel/cell_spread_gl.h"
#include "voxel/voxel_grid_gl.h"

namespace volgi::screen {

struct NegativeLightOptions {
  int count = 256;  // up to MAX_NEGATIVE_LIGHTS
  /// Where negative lights are placed, and their lobes. cochran2007: on pixels of a Halton sequence over the screen, a
  /// cosine lobe around the mean direction of the light that passes. screen, sides: on pixels, or on sides of the
  /// volume, chosen by the flux that passes through them, with a lobe as narrow as that light is.
  enum class Method { cochran2007, screen, sides } method = Method::sides;
};

/// Pass "screen/visibility/negative/negative_lights": lights to subtract, on surfaces that virtual lights reach from
/// behind (Cochran and Steele 2007, §3.3): gathered without visibility, those lights pass through the body that the
/// surface ends; the negative light takes away what passes. We depart: only the chosen places are evaluated, not all
/// pixels; the flux is physical, irradiance from behind times the area that a place stands for; and places may be sides
/// of the volume, which know surfaces that the camera does not see. Cost: virtual lights times (negative lights +
/// candidates).
class NegativeLights {
 public:
  static constexpr const char* name = "screen/visibility/negative/negative_lights";
  static constexpr const char* product_name = "negative lights";
  explicit NegativeLights(const NegativeLightOptions& options);

  /// @param voxels  for Method::sides, else null. @param sample  FrameData::sample: other places.
  void run(const GBuffer& gbuffer, const Camera& camera, const VirtualLightListGl& lights, const VoxelGridGl* voxels,
           gl::PassTimer& timer, int sample = 0);

  const gl::Buffer& buffer() const { return lights_; }  // shared::NegativeLight x MAX_NEGATIVE_LIGHTS
  int count() const { return options_.count; }
  /// Waits for the GPU; after a frame, not in one.
  std::vector<shared::NegativeLight> download() const;
  size_t bytes() const {
    return lights_.bytes() + weights_.bytes() + open_cells_.bytes() + sides_by_block_.bytes() + block_starts_.bytes() +
           (scan_ ? scan_->bytes() : 0);
  }

 private:
  void order_sides(const VoxelGridGl& voxels);
  void find_open_cells(const VoxelGridGl& voxels, int light_count);
  void choose(const VoxelGridGl* voxels);

  NegativeLightOptions options_;
  gl::Buffer lights_;
  gl::Buffer weights_;  // of candidates (shaders/screen/visibility/negative/negative_candidates.glsl)
  gl::Buffer open_cells_, sides_by_block_, block_starts_;  // of Method::sides
  gl::Program place_, weigh_, seed_, count_, list_;
  std::unique_ptr<CellSpreadGl> spread_;  // of Method::sides
  std::unique_ptr<SumInOrder> sum_;       // none of Method::cochran2007
  std::unique_ptr<gl::Scan> scan_;        // of Method::sides
};

}  // namespace volgi::screen
