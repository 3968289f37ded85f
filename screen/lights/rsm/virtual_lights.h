#pragma once
#include <optional>
#include <vector>

#include "core/emitter_points.h"
#include "core/gl/objects.h"
#include "core/gl/pass_timer.h"
#include "core/gl/program.h"
#include "core/light_shares.h"
#include "core/scene.h"
#include "core/surface_points.h"
#include "core/virtual_light_list.h"
#include "screen/base/reflective_shadow_map.h"
#include "screen/base/virtual_light_list_gl.h"
#include "screen/sources/sky/sky_maps.h"

namespace volgi::screen {

struct VirtualLightOptions {
  int count = 1024;              // of all lights together, shared among them by flux; at least one each
  std::optional<int> per_light;  // this many for every light instead (emissive surfaces together are one)
  /// halton: equal solid angles of a spot or point light, equal areas across a sun (Cochran and Steele 2007, §3.1).
  /// flux: in proportion to what texels of the reflective shadow map reflect.
  enum class Sampling { halton, flux } sampling = Sampling::halton;
  int candidates = 1;  // for each light of a source, for ResampleVirtualLights; 1: the lights themselves
  /// Instead of Halton's points, equal steps along Hilbert's curve, so that what lies between two can be looked at
  /// again (VirtualLightSubdivision).
  bool along_curve = false;
  static constexpr int kMaxCount = 65536;
};

/// Pass "screen/lights/rsm/virtual_lights": the list of virtual point lights, made on the GPU from the reflective
/// shadow maps of all lights, from points on all surfaces that the sky lights (surface_points.h; each looks at a few
/// parts of the sky), and from points on emissive surfaces. Reflected lights come first, in the order of the scene's
/// lights, the sky's behind them.
class VirtualLights {
 public:
  static constexpr const char* name = "screen/lights/rsm/virtual_lights";
  static constexpr const char* product_name = "candidates for virtual lights";
  /// @param scene  must outlive this. Its lights may change at any time, its geometry with scene_moved().
  /// @throws Error(usage) when the options ask for less than one light, or more than kMaxCount.
  VirtualLights(const Scene& scene, const VirtualLightOptions& options);

  /// @param maps  of the lights of `scene` as they are now. @param sky  of its sky; null: that is not looked at.
  /// @param sample  FrameData::sample: of n of them all lights together are those of one with n times as many.
  /// @throws Error(over_limit) when per_light times the number of sources exceeds kMaxCount.
  void run(const ReflectiveShadowMap& maps, const SkyMaps* sky, gl::PassTimer& timer, int sample = 0);
  /// The scene's geometry is another than before: its emissive surfaces are looked at again.
  void scene_moved();

  /// Where samples of a light lie, for programs with screen/lights/rsm/virtual_light_sample.glsl: sets its
  /// `world_from_axis` and `cone_height`. @returns the measure of all of them [sr], of a sun [m^2].
  double set_sampling(const gl::Program& program, const ReflectiveShadowMap& maps, int light) const;
  /// Whether samples lie at equal steps of Hilbert's curve (screen/lights/rsm/virtual_light_sample.glsl).
  bool along_curve() const {
    return options_.along_curve && options_.sampling == VirtualLightOptions::Sampling::halton;
  }

  const VirtualLightListGl& list() const { return list_; }
  const gl::Buffer& buffer() const { return list_.buffer; }
  int reflected() const { return list_.reflected; }
  int emitted() const { return list_.emitted; }
  int count() const { return list_.count(); }
  /// Waits for the GPU; after a frame, not in one.
  VirtualLightList download() const { return {scene_.world_origin, volgi::screen::download(list_)}; }
  size_t bytes() const;

 private:
  /// What the samples of one light depend on.
  struct SampleKey {
    Light::Type type;
    float outer_cone_rad;  // 0 unless a spot's
    int count, sample;
    bool operator==(const SampleKey&) const = default;
  };
  LightShares shares(bool with_sky) const;
  bool lay_out(const LightShares& shares, int sample);
  void light_by_sky(const SkyMaps& sky, bool laid_out, int first, int count);
  void make_samples(const LightShares& shares, int sample);
  void sample_evenly(const ReflectiveShadowMap& maps, int light, int sample) const;
  void sample_by_flux(const ReflectiveShadowMap& maps, int light);

  const Scene& scene_;
  VirtualLightOptions options_;
  EmitterPoints emitters_;
  VirtualLightListGl list_;
  bool moved_ = false;
  int sample_ = 0;  // that points on surfaces are of
  int sky_version_ = -1;
  std::vector<SurfaceSample> surfaces_;  // that the sky may light
  gl::Buffer samples_;                   // vec4 each: of all lights, in their order
  gl::Buffer pyramid_;                   // of one light at a time: flux_importance.glsl
  std::vector<SampleKey> keys_;
  gl::Program lights_program_, texels_program_, reduce_program_, sky_program_;
};

}  // namespace volgi::screen
