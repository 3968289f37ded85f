#pragma once
#include <map>
#include <string>
#include <vector>

#include "core/gl/pass_timer.h"
#include "core/gl/program.h"
#include "screen/gather/subsplats/flattened_buffer.h"
#include "screen/gather/subsplats/light_cache.h"
#include "screen/gather/subsplats/light_form.h"
#include "screen/gather/subsplats/subsplat_receivers.h"
#include "screen/lights/patches/light_patches.h"
#include "screen/visibility/area_maps/light_clusters.h"
#include "screen/visibility/negative/negative_lights.h"

namespace volgi::screen {

/// What is between lights and pixels; null: nothing, as the thesis has it. Ours.
struct SubsplatVisibility {
  const LightClusters* clusters = nullptr;
  const NegativeLights* negative = nullptr;
};
/// Blocks, textures and uniforms of the clusters' shadows, in a program with "CLUSTERS" and their define among its own.
void bind_clusters(const LightClusters& clusters, const gl::Program& program);
std::vector<std::string> defines_of(LightForm form, const LightClusters* clusters, bool shine);

/// Pass "screen/gather/subsplats/gather": the light of all virtual lights at the marked fragments of the flattened
/// buffer (Nichols 2010, §4.2.1.2), by full-screen draws under the stencil test, one for each block of lights; or of a
/// tree of patches that each fragment goes down as far as it needs (§4.2.4). Cost: fragments times lights.
class StencilGather {
 public:
  static constexpr const char* name = "screen/gather/subsplats/gather";
  /// @param threshold  tau of eq. 4.8, of a light's intensity, in (0, 1]: a patch whose bound exceeds it is divided.
  StencilGather(LightForm form, float threshold) : form_(form), threshold_(threshold) {}

  void run(const SubsplatReceivers& receivers, const FlattenedBuffer& target, const LightCache& lights,
           const SubsplatVisibility& visibility, gl::PassTimer& timer);
  void run(const SubsplatReceivers& receivers, const FlattenedBuffer& target, const LightPatchTree& tree,
           const SubsplatVisibility& visibility, gl::PassTimer& timer);

 private:
  const gl::Program& program(const std::string& kind, const LightClusters* clusters, bool shine);
  void begin(const SubsplatReceivers& receivers, const FlattenedBuffer& target, const gl::Program& program,
             const LightClusters* clusters);
  void take_negative(const SubsplatReceivers& receivers, const FlattenedBuffer& target, const NegativeLights& negative);

  LightForm form_;
  float threshold_;
  std::map<std::vector<std::string>, gl::Program> programs_;  // by defines, made when first wanted
};

}  // namespace volgi::screen
