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

/// After a first bounce on the screen emission has been reflected, and its arrival is wanted with all the rest.
FinalGatherCpu::Sent sent_by(const VolumeCpu& volume) {
  const bool after_first_bounce = volume.options().source == VolumeOptions::Source::first_bounce;
  FinalGatherCpu::Sent sent;
  const SideFlux& flux = volume.flux();
  for (size_t s = 0; s < flux.punctual.size(); ++s) {
    sent.reflected.emplace_back(flux.punctual[s]);
    if (after_first_bounce) sent.reflected.back() += glm::vec3(flux.emitted[s]);
    if (!after_first_bounce && flux.emits) sent.emitted.emplace_back(flux.emitted[s]);
  }
  return sent;
}

}  // namespace

const SideIrradiance* GatherSeenSides::run(const VolumeCpu& volume, const EmbreeScene& embree, const GBuffer& gbuffer,
                                           gl::PassTimer& timer) {
  const VoxelGrid& voxels = volume.voxels();
  const bool streams =
      streaming_sky(embree.scene(), volume.options()) != nullptr;  // whose arrival no ray of a side knows
  ran_ = gathers_seen_sides(volume.options()) && !streams && cell_count(voxels.grid()) <= FinalGatherCpu::MOST_CELLS;
  if (!ran_) return nullptr;
  const auto scope = timer.scope(name);
  irradiance_.direct = volume.irradiance().direct;
  positions_ = positions_of(gbuffer);
  irradiance_.indirect = gather_.run(voxels, embree, volume.passages(), sent_by(volume), volume.irradiance().indirect,
                                     cells_seen(voxels.grid(), positions_), volume.options().gather_rays);
  return &irradiance_;
}

void GatherSeenSides::run_contacts(const VolumeCpu& volume, const EmbreeScene& embree, const ContactPicture& picture,
                                   const gl::Texture& into, gl::PassTimer& timer) {
  if (ran_) contacts_.run(volume.voxels(), embree, gather_, picture, positions_, into, timer);
}

size_t GatherSeenSides::bytes() const {
  return gather_.bytes() +
         (irradiance_.direct.size() + irradiance_.indirect.size() + positions_.size()) * sizeof(glm::vec4);
}

bool gathers_seen_sides(const VolumeOptions& options) {
  return options.gather_rays > 0 && options.scheme.scheme == Scheme::ordinates && !options.bounces &&
         !options.passes_per_run && options.ranks == nullptr && !options.cascade.nested();
}

}  // namespace volgi::screen
