// Twin of side_irradiance.comp.glsl and smooth_sides.comp.glsl (docs/theory.md#reconstruction).
#include "propagation/bounces_cpu.h"
#include "propagation/reachable_cells_internal.h"
#include "propagation/side_loops.h"

namespace volgi {

namespace {

/// Mean of E over sides; `weighted` is E times the weight of the side.
struct Mean {
  glm::vec3 sum{0.0f};
  float weights_m2 = 0.0f;
  void add(glm::vec3 weighted, float weight_m2) {
    sum += weighted;
    weights_m2 += weight_m2;
  }
  glm::vec4 clamped() const { return glm::vec4(glm::max(sum, 0.0f) / weights_m2, 1.0f); }
};

/// What sides have received [W].
struct Received {
  const std::vector<glm::vec4>&direct, &indirect;
};

float weight_of(const shared::Side& s) { return shared::side_weight(s.normal, shared::face_axis(s.face), s.area_m2); }

SideIrradiance irradiance_from(const Received& received, const VolumeSides& all, size_t level, const SideFlux& flux,
                               const SideHalo* halo) {
  const VoxelGrid& voxels = all.level(level);
  const size_t number = all.first(level);
  const std::vector<shared::Side>& sides = voxels.sides();
  const size_t count = voxels.side_count();
  std::vector<glm::vec3> direct(sides.size()), indirect(sides.size());  // weighted [W]
  for_each_side(count, [&](size_t i) {
    const shared::Side& s = sides[i];
    const int axis = shared::face_axis(s.face);
    const auto weighted = [&](const glm::vec4& power, const glm::vec4& own) {
      return weight_of(s) *
             shared::side_irradiance(glm::vec3(power), glm::vec3(own), s.albedo, s.normal, axis, s.area_m2, s.face_m2);
    };
    direct[i] = weighted(received.direct[number + i], flux.emitted[number + i]);
    indirect[i] = weighted(received.indirect[number + i], flux.punctual[number + i]);
  });
  if (halo != nullptr) {
    halo->fetch(direct);
    halo->fetch(indirect);
  }
  SideIrradiance mean{std::vector<glm::vec4>(count), std::vector<glm::vec4>(count)};
  for_each_side(count, [&](size_t i) {
    Mean first, rest;
    for_sides_alike(voxels, i, [&](size_t s) {
      first.add(direct[s], weight_of(sides[s]));
      rest.add(indirect[s], weight_of(sides[s]));
    });
    mean.direct[i] = first.clamped();
    mean.indirect[i] = rest.clamped();
  });
  return mean;
}

}  // namespace

SideIrradiance side_irradiance(const VoxelGrid& voxels, const SideFlux& flux, const BouncesCpu& bounces,
                               const SideHalo* halo) {
  return side_irradiance_of_level(voxels, 0, flux, bounces, halo);
}

SideIrradiance side_irradiance_but_last(const VoxelGrid& voxels, const SideFlux& flux, const BouncesCpu& bounces) {
  const std::vector<glm::vec4> indirect = bounces.received_but_last();
  return irradiance_from({bounces.received_direct(), indirect}, voxels, 0, flux, nullptr);
}

SideIrradiance side_irradiance_of_level(const VolumeSides& all, size_t level, const SideFlux& flux,
                                        const BouncesCpu& bounces, const SideHalo* halo) {
  return irradiance_from({bounces.received_direct(), bounces.received_indirect()}, all, level, flux, halo);
}

}  // namespace volgi
