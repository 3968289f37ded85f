#pragma once
#include <map>
#include <string>
#include <vector>

#include "core/gl/objects.h"
#include "core/gl/pass_timer.h"
#include "core/gl/program.h"
#include "screen/base/gbuffer.h"
#include "screen/base/named_texture.h"
#include "screen/base/virtual_light_list_gl.h"
#include "screen/base/work_list.h"
#include "screen/visibility/imperfect/light_maps.h"
#include "screen/visibility/negative/negative_lights.h"

namespace volgi::screen {

/// Which pixels are gathered (Cochran and Steele 2007, §3.5).
struct GatherOptions {
  int stride = 2;  // every stride-th pixel in both directions first, the others only where they differ; 1: all
  /// A pixel differs when its normal, or the way to a coarse pixel off its tangent plane, turns by more than this.
  float threshold_rad = 0.2f;
  float contrast = 0.15f;  // or when coarse irradiances around it do by more than this part of the largest
  float distance = 0.05f;  // or when it is farther than this part of the scene's diagonal away from them
};

/// Passes "screen/gather/strided/virtual_light_gather" and "screen/gather/strided/discontinuity": the light of all
/// virtual lights on every pixel, less what negative lights take away, never below zero. Nothing is read back: pixels
/// to gather again are listed and dispatched by the GPU. Cost: lights times pixels gathered.
class VirtualLightGather {
 public:
  static constexpr const char* name = "screen/gather/strided/virtual_light_gather";
  static constexpr const char* discontinuity_name = "screen/gather/strided/discontinuity";
  VirtualLightGather(glm::ivec2 size, const GatherOptions& options);

  enum class Part { emitted, all };
  /// What is between lights and pixels; null: nothing.
  struct Visibility {
    const NegativeLights* negative = nullptr;  // taken from the reflected lights' irradiance
    const LightMaps* maps = nullptr;           // each light reaches as far as its own sees
  };
  /// @param part  emitted: direct() only.
  /// @param scene_diagonal_m  what options.distance is part of.
  void run(const GBuffer& gbuffer, const VirtualLightListGl& lights, const Visibility& visibility, Part part,
           float scene_diagonal_m, gl::PassTimer& timer);

  const gl::Texture& direct() const { return direct_; }      // RGBA32F: arrival of emission [W m^-2 sr^-1]
  const gl::Texture& indirect() const { return indirect_; }  // RGBA32F: the first reflection of punctual light
  /// Share of the pixels that was not gathered again at full resolution; 0 with stride 1. Waits for the GPU.
  float coarse_share() const;
  size_t bytes() const;
  void list_textures(std::vector<NamedTexture>& list) const {
    list_texture(list, name, "direct", direct_);
    list_texture(list, name, "indirect", indirect_);
    list_texture(list, name, "coarse direct", coarse_direct_);
    list_texture(list, name, "coarse indirect", coarse_indirect_);
  }

 private:
  enum class Points { grid, list };
  const gl::Program& gather_program(Points points, bool in_the_air, const Visibility& visibility);
  void gather(Points points, const VirtualLightListGl& lights, int first, int end, const Visibility& visibility,
              const gl::Texture& target);
  void find_discontinuities(const GBuffer& gbuffer, bool with_direct, float scene_diagonal_m);

  GatherOptions options_;
  glm::ivec2 size_;
  gl::Texture direct_, indirect_, coarse_direct_, coarse_indirect_;
  WorkList list_;  // WorkListHead of shaders/screen/base/work_list.glsl, then pixels
  std::map<std::vector<std::string>, gl::Program> gather_;  // by defines, made when first wanted
  gl::Program discontinuity_;
};

}  // namespace volgi::screen
