#include "propagation/transport_conservative_cpu.h"

#include <algorithm>
#include <array>
#include <cassert>

#include "propagation/lobes/sh_lobes_coarse.h"
#include "propagation/lobes/sh_lobes_radiance.h"

namespace volgi {

namespace {

// Of a pulse's power: what the coarse part may carry where passes are not counted. It costs 0.13 % of the irradiance in
// a closed box (tests), which is within the tolerance of BounceRules, and saves a third of the passes.
constexpr double kCoarseShare = 0.02;

// Of a pulse's power: while more is in flight the coarse part takes half steps, which are as accurate as the fine
// grid's but cost eight times as much for the same way. Whole steps err by 2.5 % of what is in flight.
constexpr double kHalfStepShare = 0.1;

constexpr int kBatch = 8;  // passes between two looks at the power in flight, as the GPU's
constexpr int kStride = kLobeBands * kLobeLeafCells;

constexpr std::array<std::uint64_t, kLobeRows> kAllOpen{};  // LeafWalls::closed

constexpr int coefficients(int order) { return order == 1 ? 4 : 9; }

// A pulse that has not ended after 64 crossings of the grid never will (a closed box without losses).
int longest_pulse(const Grid& g) { return 64 * (g.cells.x + g.cells.y + g.cells.z); }

}  // namespace

/// The end of a pulse on the grid of twice the edge.
struct ConservativeTransportCpu::CoarsePart {
  CoarsePart(const VoxelGrid& half_voxels, int order, const RanksOfVolume* of)
      : voxels(half_voxels),
        ranks(of),
        transport(half_voxels, order, nullptr, nullptr, of),
        received(half_voxels.side_count()) {}

  const VoxelGrid& voxels;
  const RanksOfVolume* ranks;  // null: there is one
  ConservativeTransportCpu transport;
  std::vector<glm::vec4> received;
  std::unique_ptr<CoarseLink> link;  // made on first use
  size_t bytes() const {
    return transport.bytes() + received.size() * sizeof(received[0]) + (link ? link->bytes() : 0);
  }
};

ConservativeTransportCpu::ConservativeTransportCpu(const VoxelGrid& voxels, int order, const VoxelGrid* half_voxels,
                                                   const LobeKernels* kernels, const RanksOfVolume* ranks,
                                                   const RanksOfVolume* half_ranks)
    : voxels_(voxels),
      order_(order),
      ranks_(ranks),
      kernels_(kernels != nullptr ? *kernels : lobe_kernels(order)),
      wave_(LeafNumbers(voxels.held(), voxels.part()), coefficients(order), ranks),
      walls_(collect_walls(voxels, wave_.numbers())) {
  assert(order == 1 || order == 2);
  assert(half_voxels == nullptr || (ranks == nullptr) == (half_ranks == nullptr));
  if (half_voxels != nullptr) coarse_ = std::make_unique<CoarsePart>(*half_voxels, order, half_ranks);
  // A side sends as one sixth of isotropic light would pass there: six times what comes in of an isotropic lobe.
  std::vector<float> cells(size_t(coefficients(order) * kStride), 0.0f), lobe(cells.size());
  cells[0] = 1.0f;
  for (int face = 0; face < 6; ++face) {
    lobe.assign(lobe.size(), 0.0f);
    kernels_.add_crossing(cells.data(), face, 6.0f, lobe.data());
    for (int k = 0; k < coefficients(order); ++k) side_lobes_[face][k] = lobe[size_t(k) * kStride];
  }
}

ConservativeTransportCpu::~ConservativeTransportCpu() = default;

void ConservativeTransportCpu::begin(std::span<const glm::vec4> sent) {
  assert(sent.size() == voxels_.side_count());
  std::vector<int> leaves;
  for (int n = 0; n < numbers().count(); ++n) {
    if (!numbers().own(n)) continue;
    const LeafWalls* walls = walls_[size_t(n)].get();
    const bool sends = walls != nullptr && std::any_of(walls->sides.begin(), walls->sides.end(), [&](const auto& s) {
                         return glm::vec3(sent[s.side]) != glm::vec3(0.0f);
                       });
    if (sends || wave_.dense()) leaves.push_back(n);
  }
  wave_.start(std::move(leaves),
              [&](int number, float* out, LeafLight& light) { emit_leaf(number, sent, out, light); });
  sent_ = looked_at_ = in_flight();
  passes_ = 0;
}

void ConservativeTransportCpu::emit_leaf(int number, std::span<const glm::vec4> sent, float* out, LeafLight& light) {
  std::fill(out, out + lobes().leaf_floats(), 0.0f);
  if (const LeafWalls* walls = walls_[size_t(number)].get()) {
    for (const SideRow& row : walls->rows) {
      const LeafWalls::SideThere* there = &walls->sides[row.first];
      float power[kLobeBands][8] = {};
      for (unsigned bits = row.cells; bits != 0; bits &= bits - 1, ++there) {
        for (int band = 0; band < kLobeBands; ++band) power[band][__builtin_ctz(bits)] = sent[there->side][band];
      }
      kernels_.add_lobes(side_lobes_[row.face], 8 * row.row, 8, power, out);
    }
  }
  kernels_.rescale(out, kAllRows, out, false, light);
}

void ConservativeTransportCpu::pass(std::span<glm::vec4> received, bool reflect_hits) {
  wave_.step([&](int number, float* out, LeafLight& light) { pass_leaf(number, received, reflect_hits, out, light); });
  ++passes_;
}

void ConservativeTransportCpu::pass_leaf(int number, std::span<glm::vec4> received, bool reflect_hits, float* out,
                                         LeafLight& light) {
  const std::uint64_t rows = half_steps_ ? kAllRows : wave_.rows_reached(number);
  wave_.write_only(number, rows);
  const float* beside[6];
  wave_.find_beside(number, beside);
  const float* own = lobes().leaf(number);
  const float* ahead = lobes().leaf(std::min(number + 2, numbers().count() - 1));
  fetch_faces(number);
  const LeafWalls* walls = walls_[size_t(number)].get();
  const std::uint64_t walled = half_steps_ ? rows : walls != nullptr ? rows & walls->walled_rows : 0;
  light = {};
  if (rows != walled) kernels_.gather_rescale(own, beside, ahead, rows & ~walled, out, wave_.streams(), light);
  if (walled == 0) return;
  alignas(64) float gathered[9 * kLobeBands * kLobeLeafCells];
  if (half_steps_) {
    kernels_.gather_half(own, beside, walls != nullptr ? walls->closed.data() : kAllOpen.data(), gathered);
  } else {
    kernels_.gather(own, beside, walls->closed.data(), ahead, walled, gathered);
  }
  if (walls != nullptr) hit_sides(number, *walls, walled, received, reflect_hits, gathered);
  LeafLight beside_walls;
  kernels_.rescale(gathered, walled, out, wave_.streams(), beside_walls);
  for (int band = 0; band < kLobeBands; ++band) light.power[band] += beside_walls.power[band];
  light.lit_rows |= beside_walls.lit_rows;
  light.lit_low |= beside_walls.lit_low;
  light.lit_high |= beside_walls.lit_high;
}

/// The next leaf's neighbours at +x and +y have not been read in this pass: prefetches what it will need of them.
void ConservativeTransportCpu::fetch_faces(int number) const {
  const LobeVolume& now = lobes();
  if (number + 1 >= numbers().count()) return;
  const int x = numbers().beside(number + 1, 1), y = numbers().beside(number + 1, 3);
  for (size_t block = 0; block < now.leaf_floats(); block += kLobeLeafCells) {
    for (int i = 0; i < 64 && x >= 0; i += 16) __builtin_prefetch(now.leaf(x) + block + i, 0, 2);
    for (int i = 0; i < kLobeLeafCells && y >= 0; i += 64) __builtin_prefetch(now.leaf(y) + block + i, 0, 2);
  }
}

void ConservativeTransportCpu::hit_sides(int number, const LeafWalls& walls, std::uint64_t rows,
                                         std::span<glm::vec4> received, bool reflect_hits, float* out) {
  const float* own = lobes().leaf(number);
  const float step = half_steps_ ? 0.5f : 1.0f;
  const std::uint64_t lit = half_steps_ ? kAllRows : wave_.rows_lit(number);
  for (const SideRow& row : walls.rows) {
    // What is dark is hit by nothing, but may let through what comes from beside it.
    if (((row.partly ? rows : lit) >> row.row & 1u) == 0) continue;
    const LeafWalls::SideThere* there = &walls.sides[row.first];
    const bool one = (row.cells & (row.cells - 1)) == 0;  // as where walls across z are
    const int count = one ? 1 : 8;
    const int first = one ? __builtin_ctz(row.cells) : 0;
    float power[kLobeBands][8];
    float returned[kLobeBands][8] = {};
    kernels_.face_powers(own, row.face, 8 * row.row + first, count, power);
    for (unsigned bits = row.cells; bits != 0; bits &= bits - 1, ++there) {
      const int z = __builtin_ctz(bits), i = z - first;
      const glm::vec3 hit = step * there->coverage * glm::vec3(power[0][i], power[1][i], power[2][i]);
      received[there->side] += glm::vec4(hit, 0.0f);
      if (there->coverage < 1.0f) pass_partly(number, row, z, step * (1.0f - there->coverage), out);
      for (int band = 0; band < kLobeBands; ++band) returned[band][i] = hit[band] * there->returned[band];
    }
    if (reflect_hits) kernels_.add_lobes(side_lobes_[row.face], 8 * row.row + first, count, returned, out);
  }
}

/// What a partly covered face lets through.
void ConservativeTransportCpu::pass_partly(int number, const SideRow& row, int z, float share, float* out) {
  const glm::ivec3 cell = kLeafCells * numbers().block(number) + glm::ivec3(row.row >> 3, row.row & 7, z);
  const glm::ivec3 from = cell + shared::face_step(row.face);
  if (!shared::cell_inside(voxels_.grid(), from)) return;
  const float* there = lobes().leaf(numbers().number(from / kLeafCells)) + leaf_offset(from);
  for (int band = 0; band < kLobeBands; ++band)
    kernels_.add_crossing(there + lobe_block(0, band), row.face, share, out + lobe_block(0, band) + 8 * row.row + z);
}

/// Judged by the last look. The coarse part takes over earlier.
bool ConservativeTransportCpu::ended(const BounceRules& rules) const {
  if (!coarse_) return rules.pulse_ended(glm::vec3(looked_at_), glm::vec3(sent_));
  return glm::all(glm::lessThanEqual(looked_at_, kCoarseShare * sent_));
}

/// What is in flight is carried to its end on the coarse grid.
glm::vec3 ConservativeTransportCpu::end_coarsely(std::span<glm::vec4> received, const BounceRules& rules) {
  CoarsePart& c = *coarse_;
  ConservativeTransportCpu& t = c.transport;
  if (!c.link) {
    std::optional<CoarseLink::OfRanks> ranks;
    if (ranks_ != nullptr) ranks.emplace(CoarseLink::OfRanks{*ranks_, *c.ranks});
    c.link = std::make_unique<CoarseLink>(voxels_, c.voxels, coefficients(order_), ranks);
  }
  c.link->fetch_moved(lobes(), kernels_);
  t.wave_.start(c.link->reached(lobes()), [&](int number, float* out, LeafLight& light) {
    c.link->gather(lobes(), kernels_, number, out);
    kernels_.rescale(out, kAllRows, out, false, light);
  });
  const glm::dvec3 lost = in_flight() - t.in_flight();
  std::fill(c.received.begin(), c.received.end(), glm::vec4(0.0f));
  const int limit = longest_pulse(voxels_.grid());
  for (int i = 0; i < limit && !rules.pulse_ended(glm::vec3(t.in_flight()), glm::vec3(sent_)); ++i) {
    t.half_steps_ = glm::any(glm::greaterThan(t.in_flight(), kHalfStepShare * sent_));
    t.pass(c.received, rules.together());
  }
  return glm::vec3(lost + t.in_flight() + c.link->spread(c.received, received));
}

bool ConservativeTransportCpu::advance(std::span<glm::vec4> received, int max_passes, const BounceRules& rules,
                                       BounceReport& report) {
  // As the GPU: the look at the power in flight comes a batch late, and how advance() is called does not matter.
  const int limit = rules.iterations ? *rules.iterations : longest_pulse(voxels_.grid());
  bool ends = passes_ >= limit;
  for (int i = 0; i < max_passes && !ends; ++i) {
    if (passes_ % kBatch == 0) looked_at_ = in_flight();
    pass(received, rules.together());
    ++report.passes;
    const bool looks = passes_ % kBatch == 0 && !rules.iterations;
    ends = passes_ >= limit || (looks && ended(rules));
  }
  if (ends) report.left += coarse_ ? end_coarsely(received, rules) : glm::vec3(in_flight());
  return ends;
}

RadianceVolume ConservativeTransportCpu::radiance(std::span<const glm::vec4> sent) {
  LobeSum sum(numbers(), coefficients(order_));
  std::vector<glm::vec4> ignored(voxels_.side_count(), glm::vec4(0.0f));
  BounceRules rules;
  BounceReport report;
  std::unique_ptr<CoarsePart> coarse = std::move(coarse_);  // light that is carried coarsely would be missing
  begin(sent);
  do {
    sum.add(lobes(), kernels_);
  } while (!advance(ignored, 1, rules, report));
  coarse_ = std::move(coarse);
  return sum.radiance(voxels_.grid());
}

size_t ConservativeTransportCpu::bytes_for(const Grid& grid, int order, const ExpectedSides& expected) {
  return bytes_for(LeafNumbers(grid.cells), order, expected);
}

size_t ConservativeTransportCpu::bytes_for(const RanksOfVolume& ranks, int order, const ExpectedSides& expected) {
  const BlockBox part = ranks.part();
  const glm::ivec3 around(0, 1, 1);
  const BlockBox held{glm::max(part.first - around, 0), glm::min(part.last + around, ranks.decomposition.blocks())};
  return bytes_for(LeafNumbers(held, part), order, expected);
}

size_t ConservativeTransportCpu::bytes_for(const LeafNumbers& numbers, int order, const ExpectedSides& expected) {
  const size_t rows = expected.sides / 3;  // of 8 cells, on one face: some hold one side, some eight
  return LobeWave::bytes_for(numbers, coefficients(order)) +
         size_t(numbers.count()) * sizeof(std::unique_ptr<LeafWalls>) + expected.blocks * sizeof(LeafWalls) +
         rows * sizeof(SideRow) + expected.sides * sizeof(LeafWalls::SideThere);
}

size_t ConservativeTransportCpu::bytes() const {
  size_t walls = 0;
  for (const auto& w : walls_) {
    if (w) walls += sizeof(LeafWalls) + w->rows.size() * sizeof(SideRow) + w->sides.size() * sizeof(w->sides[0]);
  }
  return wave_.bytes() + (coarse_ ? coarse_->bytes() : 0) + walls + walls_.size() * sizeof(walls_[0]);
}

}  // namespace volgi
