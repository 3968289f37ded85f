#include "propagation/side_flux_gl.h"

#include <algorithm>

#include "shaders/propagation/slots.shared.h"
#include "shaders/shared/group_sizes.shared.h"

namespace volgi {

namespace {

constexpr size_t kFluxBytes = sizeof(glm::vec4);           // of a side
constexpr size_t kPieceBytes = 3 * sizeof(glm::vec4);      // inject_emitters.comp.glsl
constexpr size_t kFixedBytes = 2 * sizeof(std::uint32_t);  // a sum of fixed_flux.glsl

}  // namespace

SideFluxGl::SideFluxGl()
    : inject_emitters_(gl::Program::compute("propagation/inject_emitters.comp.glsl")),
      collect_(gl::Program::compute("propagation/collect_flux.comp.glsl")),
      fixed_lost_(3 * kFixedBytes),
      lost_(sizeof(glm::vec4)) {
  fixed_lost_.clear();
}

void SideFluxGl::begin(const VoxelGridGl& voxels) {
  if (capacity_ != voxels.side_capacity) {
    capacity_ = voxels.side_capacity;
    emitted_ = gl::Buffer(kFluxBytes * size_t(capacity_));
    punctual_ = gl::Buffer(kFluxBytes * size_t(capacity_));
    fixed_ = gl::Buffer(3 * kFixedBytes * size_t(capacity_));
    fixed_.clear();
  }
  emitted_.clear();
  punctual_.clear();
  lost_.clear();
}

void SideFluxGl::begin_source(const VoxelGridGl& voxels, const gl::Program& program, float source_power) {
  source_power_ = std::max(source_power, 1e-30f);
  voxels.bind();
  fixed_.bind_storage(FLUX_FIXED_SLOT);
  fixed_lost_.bind_storage(FLUX_LOST_SLOT);
  program.set("source_power", source_power_);
}

void SideFluxGl::collect(const VoxelGridGl& voxels, const gl::Buffer& into) {
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  voxels.bind();
  fixed_.bind_storage(FLUX_FIXED_SLOT);
  fixed_lost_.bind_storage(FLUX_LOST_SLOT);
  into.bind_storage(SOURCE_SLOT);
  lost_.bind_storage(LOST_SLOT);
  collect_.use();
  collect_.set("source_power", source_power_);
  gl::dispatch_linear(capacity_, LINEAR_GROUP);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

void SideFluxGl::inject_emitters(const VoxelGridGl& voxels, const std::vector<FluxSample>& pieces, gl::PassTimer& timer,
                                 bool apart) {
  if (pieces.empty()) return;
  auto scope = timer.scope("propagation/inject_emitters");
  std::vector<glm::vec4> packed;
  packed.reserve(kPieceBytes / sizeof(glm::vec4) * pieces.size());
  glm::dvec3 total(0.0);
  for (const FluxSample& p : pieces) {
    packed.emplace_back(p.position, 0.0f);
    packed.emplace_back(p.normal, 0.0f);
    packed.emplace_back(p.flux, 0.0f);
    total += glm::dvec3(p.flux);
  }
  gl::put(pieces_, packed);
  begin_source(voxels, inject_emitters_, float(std::max({total.x, total.y, total.z})));
  pieces_.bind_storage(PIECES_SLOT);
  inject_emitters_.use();
  inject_emitters_.set("piece_count", int(pieces.size()));
  gl::dispatch_linear(pieces.size(), LINEAR_GROUP);
  collect(voxels, apart ? emitted_ : punctual_);
}

glm::vec3 SideFluxGl::lost() const { return glm::vec3(lost_.download<glm::vec4>(1)[0]); }

size_t SideFluxGl::bytes() const {
  return emitted_.bytes() + punctual_.bytes() + fixed_.bytes() + fixed_lost_.bytes() + lost_.bytes() + pieces_.bytes();
}

size_t SideFluxGl::bytes_for(std::uint32_t side_capacity, size_t pieces) {
  return (2 * kFluxBytes + 3 * kFixedBytes) * side_capacity + kPieceBytes * pieces + 3 * kFixedBytes + kFluxBytes;
}

}  // namespace volgi
