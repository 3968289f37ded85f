#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/gl/pass_timer.h"
#include "core/gl/program.h"
#include "screen/gather/subsplats/flattened_buffer.h"
#include "screen/gather/subsplats/light_cache.h"
#include "screen/gather/subsplats/stencil_gather.h"
#include "screen/gather/subsplats/subsplat_receivers.h"
#include "screen/gather/subsplats/subsplat_refinement.h"

namespace volgi::screen {

/// Pass "screen/gather/subsplats/splat": every virtual light to every subsplat of a list, as points that are added to
/// the flattened buffer in the lights' order (Nichols 2010, §3.2.4). What a gather over the same fragments gives, but
/// for the order of rounding. Cost: subsplats times lights, each a vertex and a fragment.
class Splat {
 public:
  static constexpr const char* name = "screen/gather/subsplats/splat";
  explicit Splat(LightForm form) : form_(form) {}

  /// All lights to one list.
  void run(const SubsplatReceivers& receivers, const FlattenedBuffer& target, const LightCache& lights,
           const SubsplatRefinement& subsplats, const SubsplatVisibility& visibility, gl::PassTimer& timer);
  /// Each light to a list of its own, which is refined in between.
  /// @param most_difference  as SubsplatRefinement::run().
  void run_each(const SubsplatReceivers& receivers, const DiscontinuityMipmaps& mipmaps, const FlattenedBuffer& target,
                const LightCache& lights, SubsplatRefinement& subsplats, float most_difference,
                const LightClusters* clusters, gl::PassTimer& timer);

 private:
  const gl::Program& program(const std::string& kind, const LightClusters* clusters, bool shine);
  void begin(const SubsplatReceivers& receivers, const FlattenedBuffer& target, const gl::Program& program,
             const LightClusters* clusters, FlattenedBuffer::Draw draw);

  LightForm form_;
  std::map<std::vector<std::string>, gl::Program> programs_;  // by defines, made when first wanted
};

}  // namespace volgi::screen
