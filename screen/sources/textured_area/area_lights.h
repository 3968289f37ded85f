#pragma once
#include "core/emitter_points.h"
#include "core/gl/objects.h"
#include "core/gl/pass_timer.h"
#include "core/scene.h"
#include "shaders/shared/virtual_light.shared.h"

namespace volgi::screen {

struct AreaLightOptions {
  int lights = 256;  // of all emissive meshes together
  /// importance: as many where the texture is bright. grid: even cells, whatever they show (Nichols 2010, §5.3.2);
  /// where emissive meshes have more triangles than there are lights, importance.
  enum class Sampling { grid, importance } sampling = Sampling::importance;
};

/// Pass "screen/sources/textured_area/area_lights": every emissive mesh as an area light, its texture kept: virtual
/// lights on it, one- or two-sided as its material is, uploaded when the scene has moved or another picture of many
/// begins, neighbours beside one another in the list. Source: Nichols 2010, §5.3.2 (16 x 16 on a grid; 32 x 32 ... 128
/// x 128 in §5.4.7); we depart: by default lights stand where the light is, which on a black screen with one bright
/// square are those on the square (its Fig. 5.15). Cost: a look at the texture for each light, on the CPU.
class AreaLights {
 public:
  static constexpr const char* name = "screen/sources/textured_area/area_lights";
  static constexpr const char* product_name = "area lights";
  static constexpr int kMaxLights = 16384;
  /// @param scene  must outlive this.
  AreaLights(const Scene& scene, const AreaLightOptions& options);

  /// @param sample  FrameData::sample; a grid stays where it is.
  void run(gl::PassTimer& timer, int sample = 0);
  /// The scene's geometry, or what it emits, is another than before.
  void scene_moved();

  const EmitterPoints& emitters() const { return emitters_; }
  const gl::Buffer& buffer() const { return buffer_; }  // shared::VirtualLight, VIRTUAL_LIGHT_EMITTED, count() of them
  int count() const { return count_; }
  /// How closely lights stand where a surface emits radiosity B [W m^-2], on the mean [m^-2]: by the luminance of B,
  /// ...
  float lights_per_watt() const { return lights_per_watt_; }
  float lights_per_m2() const { return lights_per_m2_; }  // ... and however little that is
  /// Waits for the GPU.
  std::vector<shared::VirtualLight> download() const;
  size_t bytes() const { return buffer_.bytes(); }

 private:
  const Scene& scene_;
  AreaLightOptions options_;
  EmitterPoints emitters_;
  gl::Buffer buffer_;
  int count_ = 0, sample_ = -1;
  float lights_per_watt_ = 0.0f, lights_per_m2_ = 0.0f;
};

}  // namespace volgi::screen
