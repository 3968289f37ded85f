#pragma once
#include <optional>

#include "core/gl/objects.h"
#include "core/gl/pass_timer.h"
#include "core/gl/program.h"
#include "screen/base/gbuffer.h"
#include "screen/base/named_texture.h"
#include "screen/base/virtual_light_list_gl.h"
#include "screen/gather/interleaved/geometry_blur.h"
#include "screen/gather/interleaved/worst_pixels.h"
#include "screen/visibility/area_maps/area_light_shadow.h"
#include "screen/visibility/area_maps/virtual_area_lights.h"

namespace volgi::screen {

struct AreaLightGatherOptions {
  float near_zone = 0.0f;  // leaves this zone of each light to NearLights
  /// n: pixels of a block of n x n share the lights, 1 / n^2 to each, and a blur over such blocks joins them. 1, 2, 4
  /// or 8; 1 gathers every light at every pixel, without blur.
  int interleave = 4;
  /// The pixels with the largest error estimates, as many as this number of rows of the picture holds, are gathered
  /// again with every light. They lie along edges and shadows, which are lines: their number grows as rows do. 10 and
  /// blocks of 4 x 4 leave 3 % at 192 rows, for 12 to 14 % of the time of every light at every pixel.
  float exact_rows = 10.0f;
  GeometryBlurOptions blur;
};

/// Passes "screen/gather/interleaved/arrange_lights", "screen/gather/interleaved/area_light_gather",
/// "screen/gather/interleaved/geometry_blur" and "screen/gather/interleaved/exact_pixels": the light of all virtual
/// lights on every pixel, each seen as far as its area light is (Dong et al. 2009, §4 and §6: interleaved sampling
/// after Segovia et al. 2006, a blur that does not cross edges of geometry). We depart: in the subsets: neighbours in
/// the order of clusters, so that a pixel looks at few shadows, and subsets that follow on one another lie far apart in
/// the block; in the blur: it interpolates every subset between the nearest pixels that have it, instead of a mean; and
/// the pixels with the largest error estimates, by what the blur has seen vary, are gathered again with every light.
/// Cost a pixel: lights / n^2, and exact_rows / rows of all of them; 6 n - 3 texels of the blur.
class AreaLightGather {
 public:
  static constexpr const char* arrange_name = "screen/gather/interleaved/arrange_lights";
  static constexpr const char* name = "screen/gather/interleaved/area_light_gather";
  static constexpr const char* blur_name = "screen/gather/interleaved/geometry_blur";
  static constexpr const char* exact_name = "screen/gather/interleaved/exact_pixels";
  /// @throws Error(usage) when interleave is none of its values, or exact_rows is negative or not finite.
  static void check(const AreaLightGatherOptions& options);
  /// @throws Error as check().
  AreaLightGather(glm::ivec2 size, const AreaLightGatherOptions& options, const AreaLightShadow& shadow);

  /// @param sample  FrameData::sample: every pixel of a block takes the next subset, in n^2 of them each.
  void run(const GBuffer& gbuffer, const VirtualLightListGl& lights, const VirtualAreaLights& area_lights,
           const ParaboloidDepthMaps& maps, const AreaLightShadow& shadow, float scene_diagonal_m, gl::PassTimer& timer,
           int sample = 0);

  const gl::Texture& direct() const { return direct_; }      // RGBA32F: arrival of emission [W m^-2 sr^-1]
  const gl::Texture& indirect() const { return indirect_; }  // RGBA32F: the first reflection of punctual light
  size_t bytes() const;
  void list_textures(std::vector<NamedTexture>& list) const {
    list_texture(list, name, "direct irradiance", direct_irradiance_);
    list_texture(list, name, "indirect irradiance", indirect_irradiance_);
    if (blur_) list_texture(list, blur_name, "error estimate", blur_->error_estimate());
    list_texture(list, exact_name, "direct", direct_);
    list_texture(list, exact_name, "indirect", indirect_);
  }

 private:
  struct Range {
    int first, end;  // of the lights in the order of their clusters
  };
  void arrange(const VirtualLightListGl& lights, const VirtualAreaLights& area_lights);
  void gather_interleaved(int sample);
  void gather_listed();
  template <class Dispatch>
  void gather(const gl::Program& program, Range lights, const Dispatch& dispatch);

  AreaLightGatherOptions options_;
  glm::ivec2 size_;
  gl::Texture direct_, indirect_;
  gl::Texture direct_irradiance_, indirect_irradiance_;
  gl::Buffer arranged_;  // shared::VirtualLight in the order of clusters; source is the area light
  int light_count_ = 0;
  bool with_direct_ = false;
  // None where every pixel takes every light.
  std::optional<GeometryBlur> blur_;
  std::optional<WorstPixels> worst_;
  gl::Program arrange_, gather_, gather_listed_;
};

}  // namespace volgi::screen
