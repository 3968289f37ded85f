#pragma once
#include <array>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "core/gl/objects.h"
#include "core/gl/pass_timer.h"
#include "core/gl/program.h"
#include "core/scene.h"
#include "screen/base/reflective_shadow_map.h"
#include "screen/base/virtual_light_list_gl.h"
#include "shaders/screen/lights/lattice/lattice.shared.h"

namespace volgi::screen {

struct WaveLatticeOptions {
  float angle_deg = 5.0f;  // between rays about and along the light's axis
  int shells = 5;          // lights on each ray, up to LATTICE_MAX_SHELLS
  float farthest = 0.8f;   // distance of the last shell over the scene's depth
  float growth = 2.0f;     // of distances from shell to shell
  /// What the depth is of which shells are parts: `scene` the farthest surface that the light sees, so that shells are
  /// hemispheres; `ray` the surface that each ray meets.
  enum class Depth { scene, ray } depth = Depth::scene;
  /// The text gives no unit of power. printed: what the light sends, shared out evenly, attenuated by distance, times a
  /// factor for each shell. conserving: what surfaces reflect of it (docs/theory.md#wave-lattice).
  enum class Power { printed, conserving } power = Power::conserving;
  float attenuation = 1.0f;  // printed: exp(-attenuation · distance over depth) is left
  std::array<float, LATTICE_MAX_SHELLS> factor{1.0f, 1.0f, 1.0f, 1.0f, 1.0f, 1.0f, 1.0f, 1.0f};  // printed, by shell
  float on_percent = 100.0f;  // of the lights, which then stand for the others
  int seed = 0;               // of the choice
};

/// Rays and lights of one primary light's lattice.
struct LatticeSize {
  int about = 0;   // rays in a circle about the axis
  int along = 0;   // circles
  int across = 0;  // of a sun: rays are a square of so many
  int rays = 0;
  int lights = 0;
  float step_rad = 0.0f;  // between circles
};
/// A spot fills a hemisphere about its axis, whatever its cone; a point light a sphere about -Y; a sun, which is ours,
/// a plane with as many rays as a hemisphere has, but for the square's edge being whole. At 5 degrees: 72 · 18 + 1 =
/// 1297 rays, 6485 lights in 5 shells.
LatticeSize lattice_size(Light::Type type, float angle_deg, int shells);
/// Which of `count` lights are on: every one with the probability `share`, evenly spread; the same for a seed.
/// Over all seeds the mean is that of all lights.
std::vector<int> lattice_lights_on(int count, float share, int seed);

/// Pass "screen/lights/lattice/wave_lattice": virtual lights in the air around each punctual light, on rays that run
/// out from it, at distances that grow geometrically: waves of light, in place of its reflections (wave-vpl-lattice
/// excerpt, section 4.2; lattice_light.shared.h has what they send where). Depths and powers come from the reflective
/// shadow maps. Nothing is read back; the same every time. Cost: two looks at every texel of the maps, and the lights.
class WaveLattice {
 public:
  static constexpr const char* name = "screen/lights/lattice/wave_lattice";
  /// @param scene  must outlive this. Its lights may change at any time, its surfaces with scene_moved().
  /// @param bounces  that the lattice stands for; none: all.
  /// @throws Error(over_limit) when all lattices together have more than VirtualLightOptions::kMaxCount lights.
  WaveLattice(const Scene& scene, const WaveLatticeOptions& options, std::optional<int> bounces);

  void run(const ReflectiveShadowMap& maps, gl::PassTimer& timer);
  void scene_moved();

  const VirtualLightListGl& list() const { return list_; }
  size_t bytes() const { return list_.buffer.bytes() + on_.bytes() + sums_.bytes(); }

 private:
  void lay_out();
  void set_shells(const gl::Program& program) const;
  void sum_light(int light) const;
  void make_lights(int light, int first) const;

  const Scene& scene_;
  WaveLatticeOptions options_;
  std::optional<int> bounces_;
  glm::vec3 surface_albedo_{0.0f};  // mean over the scene's area
  std::vector<Light::Type> types_;  // that the layout is of
  VirtualLightListGl list_;
  gl::Buffer on_;    // int: lights that are on, of all lattices
  gl::Buffer sums_;  // LatticeSums x LATTICE_GROUPS, of one light at a time
  gl::Program farthest_program_, sums_program_, lights_program_;
};

}  // namespace volgi::screen
