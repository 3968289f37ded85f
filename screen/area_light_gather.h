#pragma once
#include "core/gl/objects.h"
#include "core/gl/pass_timer.h"
#include "core/gl/program.h"
#include "screen/area_light_shadow.h"
#include "screen/gbuffer.h"
#include "screen/virtual_area_lights.h"
#include "screen/virtual_light_list_gl.h"

namespace volgi::screen {

struct AreaLightGatherOptions {
  /// n: pixels of a block of n x n share the lights, 1 / n^2 to each, and a blur over such blocks joins them. 1, 2, 4
  /// or 8; 1 gathers every light at every pixel, without blur.
  int interleave = 8;
  /// The blur joins pixels no farther apart than this part of the scene's diagonal (alpha of the paper), ...
  float blur_distance = 0.1f;
  float blur_cosine = 0.8f;     // ... whose normals have at least this cosine (beta), ...
  float blur_off_plane = 0.2f;  // ... and which lie on one another's tangent plane, to this sine of the way's angle
};

/// Passes "screen/arrange_lights", "screen/area_light_gather" and "screen/geometry_blur": the light of all virtual
/// lights on every pixel, each seen as far as its area light is (Dong et al. 2009, §4 and §6: interleaved sampling
/// after Segovia et al. 2006, a blur that does not cross edges of geometry). We depart: lights of a block are spread
/// over its pixels in the order of their clusters, so that every pixel has some of all; and the blur's window is one
/// block wide about each pixel, with half weight at its ends, so that on a plane every light counts exactly once. Cost:
/// lights / n^2 and as many looks at shadows a pixel; 4 n + 2 texels of the blur.
class AreaLightGather {
 public:
  static constexpr const char* arrange_name = "screen/arrange_lights";
  static constexpr const char* name = "screen/area_light_gather";
  static constexpr const char* blur_name = "screen/geometry_blur";
  AreaLightGather(glm::ivec2 size, const AreaLightGatherOptions& options, const AreaLightShadow& shadow);

  void run(const GBuffer& gbuffer, const VirtualLightListGl& lights, const VirtualAreaLights& area_lights,
           const ParaboloidDepthMaps& maps, const AreaLightShadow& shadow, float scene_diagonal_m,
           gl::PassTimer& timer);

  const gl::Texture& direct() const { return direct_; }      // RGBA32F: arrival of emission [W m^-2 sr^-1]
  const gl::Texture& indirect() const { return indirect_; }  // RGBA32F: the first reflection of punctual light
  size_t bytes() const;

 private:
  void arrange(const VirtualLightListGl& lights, const VirtualAreaLights& area_lights);
  void gather(const GBuffer& gbuffer, const VirtualAreaLights& area_lights);
  void blur(const GBuffer& gbuffer, const gl::Texture& from, const gl::Texture& half, const gl::Texture& to,
            float scene_diagonal_m);

  AreaLightGatherOptions options_;
  glm::ivec2 size_;
  gl::Texture direct_, indirect_;
  gl::Texture direct_irradiance_, indirect_irradiance_, half_blurred_;
  gl::Buffer arranged_;  // shared::VirtualLight, subset after subset; source is the area light
  int lights_a_subset_ = 0;
  bool with_direct_ = false;
  gl::Program arrange_, gather_, blur_;
};

}  // namespace volgi::screen
