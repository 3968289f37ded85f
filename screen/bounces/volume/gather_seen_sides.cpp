#include "screen/bounces/volume/gather_seen_sides.h"

#include <cstring>

namespace volgi::screen {

namespace {

std::vector<glm::vec4> positions_of(const GBuffer& gbuffer) {
  const std::vector<float> values = gbuffer.position().download(4);
  std::vector<glm::vec4> positions(values.size() / 4);
  std::memcpy(positions.data(), values.data(), positions.size() * sizeof(glm::vec4));
  return positions;
}

}  // namespace

const SideIrradiance* GatherSeenSides::run(const VolumeCpu& volume, const EmbreeScene& embree, const GBuffer& gbuffer,
                                           gl::PassTimer& timer) {
  const VoxelGrid& voxels = volume.voxels();
  ran_ = gathers_seen_sides(volume.options()) && cell_count(voxels.grid()) <= FinalGatherCpu::MOST_CELLS;
  if (!ran_) return nullptr;
  const auto scope = timer.scope(name);
  const bool lights = volume.options().source == VolumeOptions::Source::lights;  // whose emission arrives in `direct`
  std::vector<glm::vec3> sent(voxels.side_count());
  for (size_t s = 0; s < sent.size(); ++s) {
    sent[s] = glm::vec3(volume.flux().punctual[s]);
    if (!lights) sent[s] += glm::vec3(volume.flux().emitted[s]);
  }
  irradiance_.direct = volume.irradiance().direct;
  irradiance_.indirect = gather_.run(voxels, embree, sent, volume.irradiance(),
                                     cells_seen(voxels.grid(), positions_of(gbuffer)), volume.options().gather_rays);
  return &irradiance_;
}

size_t GatherSeenSides::bytes() const {
  return gather_.bytes() + (irradiance_.direct.size() + irradiance_.indirect.size()) * sizeof(glm::vec4);
}

bool gathers_seen_sides(const VolumeOptions& options) {
  return options.gather_rays > 0 && options.scheme.scheme == Scheme::ordinates && !options.bounces &&
         !options.passes_per_run && options.ranks == nullptr && !options.cascade.nested();
}

}  // namespace volgi::screen
