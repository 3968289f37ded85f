#include "screen/gather/subsplats/splat.h"

#include <algorithm>

#include "shaders/screen/visibility/negative/slots.shared.h"

namespace volgi::screen {

const gl::Program& Splat::program(const std::string& kind, const LightClusters* clusters, bool shine) {
  std::vector<std::string> defines = defines_of(form_, clusters, shine);
  if (!kind.empty()) defines.push_back(kind);
  const auto found = programs_.find(defines);
  if (found != programs_.end()) return found->second;
  return programs_.emplace(defines, gl::Program::raster("screen/gather/subsplats/splat", defines)).first->second;
}

void Splat::begin(const SubsplatReceivers& receivers, const FlattenedBuffer& target, const gl::Program& program,
                  const LightClusters* clusters, FlattenedBuffer::Draw draw) {
  target.begin(draw);
  glDisable(GL_PROGRAM_POINT_SIZE);
  receivers.bind(program);
  target.levels().set(program);
  if (clusters != nullptr) bind_clusters(*clusters, program);
  program.use();
}

void Splat::run(const SubsplatReceivers& receivers, const FlattenedBuffer& target, const LightCache& lights,
                const SubsplatRefinement& subsplats, const SubsplatVisibility& visibility, gl::PassTimer& timer) {
  const auto scope = timer.scope(name);
  begin(receivers, target, program("", visibility.clusters, receivers.shine()), visibility.clusters,
        FlattenedBuffer::Draw::adds);
  for (int block = 0; block < lights.blocks(); ++block) {
    lights.bind_block(block);
    subsplats.draw(std::min(lights.most_lights() - block * VIRTUAL_LIGHTS_PER_BLOCK, VIRTUAL_LIGHTS_PER_BLOCK));
  }
  if (visibility.negative == nullptr) return;
  const gl::Program& take = program("NEGATIVE", nullptr, false);
  begin(receivers, target, take, nullptr, FlattenedBuffer::Draw::subtracts);
  visibility.negative->buffer().bind_uniform(NEGATIVE_LIGHTS_BLOCK);
  take.set("negative_count", visibility.negative->count());
  subsplats.draw(1);
}

void Splat::run_each(const SubsplatReceivers& receivers, const DiscontinuityMipmaps& mipmaps,
                     const FlattenedBuffer& target, const LightCache& lights, SubsplatRefinement& subsplats,
                     float most_difference, const LightClusters* clusters, gl::PassTimer& timer) {
  for (int first = 0; first < lights.most_lights();) {
    const int in_block = first % VIRTUAL_LIGHTS_PER_BLOCK;
    const int count =
        std::min({subsplats.lights_at_once(), VIRTUAL_LIGHTS_PER_BLOCK - in_block, lights.most_lights() - first});
    lights.bind_block(first / VIRTUAL_LIGHTS_PER_BLOCK);
    subsplats.run(receivers, mipmaps, in_block, count, most_difference, timer);
    const auto scope = timer.scope(name);
    begin(receivers, target, program("", clusters, receivers.shine()), clusters, FlattenedBuffer::Draw::adds);
    lights.bind_block(first / VIRTUAL_LIGHTS_PER_BLOCK);
    subsplats.draw(1);
    first += count;
  }
}

}  // namespace volgi::screen
