#include "propagation/light_in/volume_service.h"

#include <cassert>
#include <cstring>
#include <optional>
#include <type_traits>

#include "propagation/light_in/direct_light_cpu.h"

namespace volgi {

namespace {

enum class Order : std::uint8_t { make, run, fetch, end };

/// What is said: an order and what belongs to it.
struct Said {
  Order order;
  std::vector<std::byte> bytes;
};

/// The first rank, to all others.
void tell(const Ranks& ranks, Order order, std::span<const std::byte> bytes) {
  Ranks::Bytes said{std::byte(order)};
  said.insert(said.end(), bytes.begin(), bytes.end());
  std::vector<Ranks::Bytes> to(size_t(ranks.count()), said);
  to[size_t(ranks.rank())].clear();
  ranks.exchange(std::move(to));
}

Said hear(const Ranks& ranks) {
  const auto from = ranks.exchange(std::vector<Ranks::Bytes>(size_t(ranks.count())));
  const Ranks::Bytes& said = from[0];
  return {Order(said.at(0)), {said.begin() + 1, said.end()}};
}

template <class T>
T value_of(std::span<const std::byte> bytes) {
  static_assert(std::is_trivially_copyable_v<T>);
  T value;
  assert(bytes.size() == sizeof value);
  std::memcpy(&value, bytes.data(), sizeof value);
  return value;
}

struct SideThere {
  shared::Side side;
  glm::vec4 direct, indirect;
};

/// A bit for each block. What this rank has of those goes to the first.
std::vector<std::vector<SideThere>> send_sides(const VolumeCpu& volume, std::span<const std::byte> blocks) {
  const Ranks& ranks = volume.ranks()->ranks;
  const VoxelGrid& voxels = volume.voxels();
  std::vector<std::vector<SideThere>> to(size_t(ranks.count()));
  for (size_t i = 0; i < voxels.side_count(); ++i) {
    const shared::Side& side = voxels.sides()[i];
    const glm::ivec3 block = shared::cell_coord(voxels.grid(), side.cell) >> kLeafShift;
    if (blocks[size_t(block_index(voxels.blocks(), block))] == std::byte(0)) continue;
    to[0].push_back({side, volume.irradiance().direct[i], volume.irradiance().indirect[i]});
  }
  return exchange_values(ranks, to);
}

void run(VolumeCpu& volume, const DirectLightCpu& light, glm::vec3 shift) {
  volume.shift_grid(shift);
  volume.voxelize();
  volume.light_in(light.flux(volume.voxels(), *volume.ranks()));
  volume.propagate();
  volume.irradiate();
  VolumeLead::totals(volume);
}

}  // namespace

VolumeLead::VolumeLead(const Ranks& ranks, const VolumeOptions& options) : ranks_(ranks) {
  static_assert(std::is_trivially_copyable_v<VolumeOptions>);
  tell(ranks_, Order::make, std::as_bytes(std::span(&options, 1)));
}

void VolumeLead::run(glm::vec3 grid_shift_cells) const {
  tell(ranks_, Order::run, std::as_bytes(std::span(&grid_shift_cells, 1)));
}

VolumeLead::Totals VolumeLead::totals(const VolumeCpu& volume) {
  std::array<double, 4> own{double(volume.voxels().side_count()), 0.0, 0.0, 0.0};
  for (const auto* flux : {&volume.flux().emitted, &volume.flux().punctual}) {
    for (const glm::vec4& f : *flux) {
      for (int band = 0; band < 3; ++band) own[size_t(band) + 1] += double(f[band]);
    }
  }
  const std::vector<double> all = volume.ranks()->ranks.gather(own);
  Totals totals;
  for (size_t i = 0; i < all.size(); i += own.size()) {
    totals.sides += size_t(all[i]);
    totals.injected += glm::dvec3(all[i + 1], all[i + 2], all[i + 3]);
  }
  return totals;
}

VolumeLead::Sides VolumeLead::fetch(const VolumeCpu& volume, const std::vector<bool>& blocks) const {
  std::vector<std::byte> wanted(blocks.size());
  for (size_t i = 0; i < blocks.size(); ++i) wanted[i] = std::byte(blocks[i] ? 1 : 0);
  tell(ranks_, Order::fetch, wanted);
  Sides found;
  std::vector<shared::Side> sides;
  for (const auto& from : send_sides(volume, wanted)) {
    for (const SideThere& s : from) {
      sides.push_back(s.side);
      found.irradiance.direct.push_back(s.direct);
      found.irradiance.indirect.push_back(s.indirect);
    }
  }
  found.voxels = VoxelGrid(volume.grid(), std::move(sides));
  return found;
}

size_t VolumeLead::Sides::bytes() const {
  return voxels.bytes() + (irradiance.direct.size() + irradiance.indirect.size()) * sizeof(glm::vec4);
}

std::vector<bool> blocks_seen(const Grid& grid, std::span<const glm::vec4> positions) {
  constexpr int kReach = 6;  // cells; a pixel's search goes no farther than four from its place
  const glm::ivec3 blocks = leaf_blocks(grid);
  std::vector<bool> seen(size_t(blocks.x) * size_t(blocks.y) * size_t(blocks.z), false);
  for (const glm::vec4& p : positions) {
    if (p.w == 0.0f) continue;
    const glm::vec3 at = glm::floor(shared::cell_from_world(grid, glm::vec3(p)));
    const glm::vec3 low(-1e6f), high(1e6f);
    const glm::ivec3 cell(glm::clamp(at, low, high));
    const glm::ivec3 first = glm::max((cell - kReach) >> kLeafShift, 0),
                     last = glm::min((cell + kReach) >> kLeafShift, blocks - 1);
    for (int z = first.z; z <= last.z; ++z) {
      for (int y = first.y; y <= last.y; ++y) {
        for (int x = first.x; x <= last.x; ++x) seen[size_t(block_index(blocks, {x, y, z}))] = true;
      }
    }
  }
  return seen;
}

void serve_volume(const Scene& scene, const Ranks& ranks) {
  std::optional<VolumeCpu> volume;
  std::optional<DirectLightCpu> light;
  for (;;) {
    const Said said = hear(ranks);
    switch (said.order) {
      case Order::make: {
        volume.reset();  // first, so that there are never two
        auto options = value_of<VolumeOptions>(said.bytes);
        options.ranks = &ranks;
        volume.emplace(scene, options, &ranks);
        light.emplace(scene, lights_by_rays(scene, options));
        break;
      }
      case Order::run:
        run(*volume, *light, value_of<glm::vec3>(said.bytes));
        break;
      case Order::fetch:
        send_sides(*volume, said.bytes);
        break;
      case Order::end:
        return;
    }
  }
}

void end_volume_service(const Ranks& ranks) { tell(ranks, Order::end, {}); }

}  // namespace volgi
