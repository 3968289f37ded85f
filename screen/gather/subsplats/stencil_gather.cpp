#include "screen/gather/subsplats/stencil_gather.h"

#include <algorithm>
#include <glm/gtc/constants.hpp>

#include "shaders/screen/gather/subsplats/slots.shared.h"
#include "shaders/screen/visibility/area_maps/slots.shared.h"
#include "shaders/screen/visibility/negative/slots.shared.h"

namespace volgi::screen {

void bind_clusters(const LightClusters& clusters, const gl::Program& program) {
  clusters.area_lights.buffer().bind_uniform(AREA_LIGHTS_BLOCK);
  clusters.shadow.bind(clusters.maps, program);
}

std::vector<std::string> defines_of(LightForm form, const LightClusters* clusters, bool shine) {
  std::vector<std::string> defines = defines_of(form);
  if (clusters != nullptr) {
    defines.emplace_back("CLUSTERS");
    defines.push_back(clusters->shadow.define());
  }
  if (shine) defines.emplace_back("SHINES");
  return defines;
}

const gl::Program& StencilGather::program(const std::string& kind, const LightClusters* clusters, bool shine) {
  std::vector<std::string> defines = defines_of(form_, clusters, shine);
  if (!kind.empty()) defines.push_back(kind);
  const auto found = programs_.find(defines);
  if (found != programs_.end()) return found->second;
  return programs_
      .emplace(defines,
               gl::Program::raster("shared/fullscreen.vert.glsl", "screen/gather/subsplats/gather.frag.glsl", defines))
      .first->second;
}

void StencilGather::begin(const SubsplatReceivers& receivers, const FlattenedBuffer& target, const gl::Program& program,
                          const LightClusters* clusters) {
  target.begin(FlattenedBuffer::Draw::adds);
  receivers.bind(program);
  target.levels().set(program);
  if (clusters != nullptr) bind_clusters(*clusters, program);
  program.use();
}

void StencilGather::run(const SubsplatReceivers& receivers, const FlattenedBuffer& target, const LightCache& lights,
                        const SubsplatVisibility& visibility, gl::PassTimer& timer) {
  const auto scope = timer.scope(name);
  const gl::Program& gather = program("", visibility.clusters, receivers.shine());
  begin(receivers, target, gather, visibility.clusters);
  lights.size().bind_storage(CACHE_SIZE_SLOT);
  for (int block = 0; block < std::max(lights.blocks(), 1); ++block) {
    lights.bind_block(block);
    gather.set("first_of_block", block * VIRTUAL_LIGHTS_PER_BLOCK);
    target.draw_marked();
  }
  if (visibility.negative != nullptr) take_negative(receivers, target, *visibility.negative);
}

void StencilGather::run(const SubsplatReceivers& receivers, const FlattenedBuffer& target, const LightPatchTree& tree,
                        const SubsplatVisibility& visibility, gl::PassTimer& timer) {
  const auto scope = timer.scope(name);
  const gl::Program& gather = program("TREE", visibility.clusters, receivers.shine());
  begin(receivers, target, gather, visibility.clusters);
  tree.thirds.bind(PATCH_TREE_UNIT);
  if (visibility.clusters != nullptr) visibility.clusters->area_lights.cluster_of().bind_storage(CLUSTER_OF_SLOT);
  gather.set("root_count", tree.roots);
  gather.set("deepest", tree.deepest);
  gather.set("near_share", (1.0f - threshold_) / (glm::pi<float>() * threshold_));
  target.draw_marked();
  if (visibility.negative != nullptr) take_negative(receivers, target, *visibility.negative);
}

void StencilGather::take_negative(const SubsplatReceivers& receivers, const FlattenedBuffer& target,
                                  const NegativeLights& negative) {
  const gl::Program& take = program("NEGATIVE", nullptr, false);
  target.begin(FlattenedBuffer::Draw::subtracts);
  receivers.bind(take);
  target.levels().set(take);
  negative.buffer().bind_uniform(NEGATIVE_LIGHTS_BLOCK);
  take.set("negative_count", negative.count());
  take.use();
  target.draw_marked();
}

}  // namespace volgi::screen
