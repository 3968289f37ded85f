#include "propagation/lobes/sh_lobes_coarse.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>

#include "propagation/side_loops.h"
#include "shaders/shared/grid.shared.h"
#include "voxel/side_search.h"

namespace volgi {

namespace {

using shared::Side;

/// Whether a point (cell units) lies behind the surface of a side.
bool behind(const Side& side, glm::ivec3 cell, glm::vec3 point) {
  glm::vec3 on_surface = glm::vec3(cell) + 0.5f;
  on_surface[side.face >> 1] = side.depth;
  return glm::dot(side.normal, point - on_surface) < 0.0f;
}

/// Of the sides that `cell` has, but for `except`, one that the point lies behind; null if there is none. What lets
/// half of the light through is no wall.
const Side* wall_before(const VoxelGrid& voxels, glm::ivec3 cell, glm::vec3 point, const Side* except = nullptr) {
  const glm::uvec2 own = voxels.cell_sides(cell);
  for (std::uint32_t i = 0; i < shared::count_bits(own.y & 63u); ++i) {
    const Side& side = voxels.sides()[own.x + i];
    if (side.coverage > 0.5f && &side != except && behind(side, cell, point)) return &side;
  }
  return nullptr;
}

/// A point on the surface, at the middle of the face's column.
glm::vec3 place_of(const Grid& grid, const Side& side) {
  glm::vec3 cell = glm::vec3(shared::cell_coord(grid, side.cell)) + 0.5f;
  cell[side.face >> 1] = side.depth;
  return shared::world_from_cell(grid, cell);
}

/// A coarse side found for a fine one must be on its side of every wall: if the fine cell lies behind one, the coarse
/// cell across it is asked for a side on the same face. -1: there is none.
int on_same_side(const VoxelGrid& coarse, int found, glm::vec3 fine_centre) {
  const Side& side = coarse.sides()[size_t(found)];
  const glm::ivec3 cell = shared::cell_coord(coarse.grid(), side.cell);
  const Side* wall = wall_before(coarse, cell, fine_centre, &side);
  if (wall == nullptr) return found;
  const glm::ivec3 across = cell + shared::face_step(wall->face);
  if (!shared::cell_inside(coarse.grid(), across)) return -1;
  const glm::uvec2 there = coarse.cell_sides(across);
  if (!shared::has_side(there, side.face)) return -1;
  const Side* other = &coarse.sides()[shared::side_index(there, side.face)];
  return wall_before(coarse, across, fine_centre, other) == nullptr ? int(shared::side_index(there, side.face)) : -1;
}

}  // namespace

CoarseLink::CoarseLink(const VoxelGrid& fine, const VoxelGrid& coarse, int coefficients,
                       const std::optional<OfRanks>& ranks)
    : coefficients_(coefficients),
      fine_blocks_(fine.blocks()),
      known_sides_(coarse.sides().size()),
      fine_numbers_(fine.held(), fine.part()),
      coarse_numbers_(coarse.held(), coarse.part()),
      exceptions_(size_t(coarse_numbers_.count())) {
  if (ranks) {
    ranks_.emplace(*ranks);
    fine_halo_.emplace(ranks->fine, fine);
    coarse_halo_.emplace(ranks->coarse, coarse);
  }
  sort_cells(coarse);
  if (ranks_) ask_others();
  share_sides(fine, coarse);
  find_beside(fine);
}

CoarseLink::Exceptions& CoarseLink::exceptions(int leaf) {
  auto& e = exceptions_[size_t(leaf)];
  if (!e) {
    e = std::make_unique<Exceptions>();
    e->moved_out.assign(kLobeLeafCells, 0);
  }
  return *e;
}

/// Fine cells behind a wall of their coarse cell move to the coarse cell across it, one after the other in the order of
/// blocks, which is the same for any ranks.
void CoarseLink::sort_cells(const VoxelGrid& coarse) {
  const Grid& grid = coarse.grid();
  int last = -1;
  for (const Side& first : coarse.sides()) {
    if (first.cell == last) continue;  // sides of a cell are beside each other
    last = first.cell;
    const glm::ivec3 cell = shared::cell_coord(grid, first.cell);
    for (int child = 0; child < 8; ++child) {
      const glm::ivec3 in_cell(child >> 2, (child >> 1) & 1, child & 1);
      const glm::vec3 centre = glm::vec3(cell) + 0.25f + 0.5f * glm::vec3(in_cell);
      const Side* wall = wall_before(coarse, cell, centre);
      if (wall == nullptr) continue;
      const glm::ivec3 block = cell / kLeafCells;
      if (coarse.part().contains(block)) {
        auto& out = exceptions(coarse_numbers_.number(block)).moved_out[size_t(leaf_offset(cell))];
        out = std::uint8_t(out | (1 << child));
      }
      const glm::ivec3 to = cell + shared::face_step(wall->face);
      if (!shared::cell_inside(grid, to) || !coarse.part().contains(to / kLeafCells)) continue;
      if (wall_before(coarse, to, centre) != nullptr) continue;  // in the wall
      exceptions(coarse_numbers_.number(to / kLeafCells))
          .moved_in.push_back({2 * cell + in_cell, leaf_offset(to), block_index(coarse.blocks(), block)});
    }
  }
  for (auto& e : exceptions_) {
    if (e)
      std::stable_sort(e->moved_in.begin(), e->moved_in.end(),
                       [](const Moved& a, const Moved& b) { return a.block < b.block; });
  }
}

/// For the lobes of fine cells that move in from others' parts.
void CoarseLink::ask_others() {
  const Ranks& ranks = ranks_->fine.ranks;
  std::vector<std::vector<glm::ivec3>> wanted(size_t(ranks.count()));
  std::vector<std::pair<size_t, Moved*>> awaited;
  for (auto& e : exceptions_) {
    if (!e) continue;
    for (Moved& moved : e->moved_in) {
      const glm::ivec3 block = moved.from / kLeafCells;
      if (glm::any(glm::greaterThanEqual(block, fine_blocks_)) || fine_numbers_.part().contains(block)) continue;
      const auto rank = size_t(ranks_->fine.decomposition.owner(block));
      moved.answer = int(wanted[rank].size());
      wanted[rank].push_back(moved.from);
      awaited.emplace_back(rank, &moved);
    }
  }
  // Answers come rank after rank.
  std::vector<int> first(wanted.size(), 0);
  for (size_t rank = 1; rank < wanted.size(); ++rank) first[rank] = first[rank - 1] + int(wanted[rank - 1].size());
  for (const auto& [rank, moved] : awaited) moved->answer += first[rank];
  asked_ = exchange_values(ranks, wanted);
}

void CoarseLink::fetch_moved(const LobeVolume& fine, const LobeKernels& kernels) {
  if (!ranks_) return;
  std::vector<std::vector<float>> to(asked_.size());
  for (size_t rank = 0; rank < asked_.size(); ++rank) {
    to[rank].resize(asked_[rank].size() * moved_floats());
    for (size_t i = 0; i < asked_[rank].size(); ++i)
      moved_lobe(fine, kernels, asked_[rank][i], &to[rank][i * moved_floats()]);
  }
  answers_.clear();
  for (const auto& from : exchange_values(ranks_->fine.ranks, to))
    answers_.insert(answers_.end(), from.begin(), from.end());
}

void CoarseLink::share_sides(const VoxelGrid& fine, const VoxelGrid& coarse) {
  shares_.resize(fine.side_count());
  tbb::parallel_for(size_t(0), shares_.size(), [&](size_t i) {
    const Side& side = fine.sides()[i];
    const SidesOfPoint found = sides_of_point(coarse, place_of(fine.grid(), side), side.normal, side.front);
    const glm::vec3 centre = 0.5f * (glm::vec3(shared::cell_coord(fine.grid(), side.cell)) + 0.5f);
    for (int k = 0; k < 3; ++k) {
      if (found.sides[k] < 0) continue;
      shares_[i].sides[k] = on_same_side(coarse, found.sides[k], centre);
      shares_[i].shares[k] = found.weights[k] * side.face_m2;
    }
  });
  const std::vector<double> all = sums_of_shares(fine, coarse);
  for (Share& s : shares_) {
    for (int k = 0; k < 3; ++k) {
      const double sum = s.sides[k] >= 0 ? all[size_t(s.sides[k])] : 0.0;
      s.shares[k] = sum > 0.0 ? float(double(s.shares[k]) / sum) : 0.0f;
    }
  }
  for (std::uint32_t j = 0; j < coarse.side_count(); ++j) {
    if (all[j] <= 0.0) alone_.push_back(j);
  }
}

/// By coarse side, of what all fine sides show of it, in the order of the blocks of fine sides.
std::vector<double> CoarseLink::sums_of_shares(const VoxelGrid& fine, const VoxelGrid& coarse) const {
  std::vector<double> all(known_sides_, 0.0);
  if (!ranks_) {
    for (const Share& s : shares_) {
      for (int k = 0; k < 3; ++k) {
        if (s.sides[k] >= 0) all[size_t(s.sides[k])] += double(s.shares[k]);
      }
    }
    return all;
  }
  struct Given {
    int block, cell, face;
    float share;
  };
  const RanksOfVolume& ranks = ranks_->coarse;
  std::vector<std::vector<Given>> to(size_t(ranks.ranks.count()));
  for (size_t i = 0; i < shares_.size(); ++i) {
    const glm::ivec3 block = shared::cell_coord(fine.grid(), fine.sides()[i].cell) / kLeafCells;
    for (int k = 0; k < 3; ++k) {
      if (shares_[i].sides[k] < 0) continue;
      const Side& side = coarse.sides()[size_t(shares_[i].sides[k])];
      const int owner = ranks.decomposition.owner(shared::cell_coord(coarse.grid(), side.cell) / kLeafCells);
      to[size_t(owner)].push_back({block_index(fine.blocks(), block), side.cell, side.face, shares_[i].shares[k]});
    }
  }
  std::vector<Given> here;
  for (const auto& from : exchange_values(ranks.ranks, to)) here.insert(here.end(), from.begin(), from.end());
  std::stable_sort(here.begin(), here.end(), [](const Given& a, const Given& b) { return a.block < b.block; });
  for (const Given& g : here) {
    const glm::uvec2 own = coarse.cell_sides(shared::cell_coord(coarse.grid(), g.cell));
    all[shared::side_index(own, g.face)] += double(g.share);
  }
  coarse_halo_->fetch(all);
  return all;
}

/// The sides on the same face of the cells beside, but for where something stands between.
void CoarseLink::find_beside(const VoxelGrid& fine) {
  beside_.assign(fine.side_count(), glm::ivec4(-1));
  for (const Side& side : fine.sides()) shown_m2_.push_back(side.face_m2);
  tbb::parallel_for(size_t(0), beside_.size(), [&](size_t i) {
    const Side& side = fine.sides()[i];
    const glm::ivec3 cell = shared::cell_coord(fine.grid(), side.cell);
    for (int k = 0; k < 4; ++k) {
      const int way = 2 * (((side.face >> 1) + 1 + (k >> 1)) % 3) + (k & 1);
      const glm::ivec3 next = cell + shared::face_step(way);
      if (!shared::cell_inside(fine.grid(), next) || shared::has_side(fine.cell_sides(cell), way)) continue;
      const glm::uvec2 there = fine.cell_sides(next);
      if (shared::has_side(there, side.face) && !shared::has_side(there, way ^ 1))
        beside_[i][k] = int(shared::side_index(there, side.face));
    }
  });
}

/// Of steps two sides wide, the means 1/4, 1/2, 1/4 make what is linear between their middles. An exchange, so that
/// power is kept.
void CoarseLink::even_out(int along, std::span<const glm::vec4> from, std::span<glm::vec4> to) const {
  tbb::parallel_for(size_t(0), beside_.size(), [&](size_t i) {
    to[i] = from[i];
    if (shown_m2_[i] <= 0.0f) return;
    for (int k = 2 * along; k < 2 * along + 2; ++k) {
      const int b = beside_[i][k];
      if (b < 0 || shown_m2_[size_t(b)] <= 0.0f) continue;
      const float exchanged_m2 = 0.25f * std::min(shown_m2_[i], shown_m2_[size_t(b)]);
      to[i] += exchanged_m2 * (from[size_t(b)] / shown_m2_[size_t(b)] - from[i] / shown_m2_[i]);
    }
  });
}

std::vector<int> CoarseLink::reached(const LobeVolume& fine) const {
  std::vector<char> lit(size_t(coarse_numbers_.count()), 0);
  for (const int n : fine.leaves()) lit[size_t(coarse_numbers_.number(fine_numbers_.block(n) / 2))] = 1;
  std::vector<int> leaves;
  for (int n = 0; n < coarse_numbers_.count(); ++n) {
    if (!coarse_numbers_.own(n)) continue;
    // Cells that move in come from next door at most; whether there is light at others' nobody asks.
    bool any = lit[size_t(n)] != 0;
    for (int face = 0; face < 6 && !any && exceptions_[size_t(n)]; ++face) {
      const int beside = coarse_numbers_.beside(n, face);
      any = beside >= 0 && (lit[size_t(beside)] != 0 || !coarse_numbers_.own(beside));
    }
    if (any) leaves.push_back(n);
  }
  return leaves;
}

void CoarseLink::gather(const LobeVolume& fine, const LobeKernels& kernels, int coarse_leaf, float* out) const {
  std::fill(out, out + fine.leaf_floats(), 0.0f);
  const Exceptions* exceptions = exceptions_[size_t(coarse_leaf)].get();
  for (int i = 0; i < 8; ++i) {
    const glm::ivec3 octant(i >> 2, (i >> 1) & 1, i & 1);
    const glm::ivec3 block = 2 * coarse_numbers_.block(coarse_leaf) + octant;
    if (glm::any(glm::greaterThanEqual(block, fine_blocks_))) continue;
    const float* lobes = fine.leaf(fine_numbers_.number(block));
    if (lobes == LobeVolume::dark()) continue;
    alignas(64) float carried[9 * kLobeBands * kLobeLeafCells];
    kernels.carried(lobes, carried);
    add_children(carried, octant, exceptions, out);
  }
  if (exceptions == nullptr) return;
  for (const Moved& moved : exceptions->moved_in) add_moved(fine, kernels, moved, out);
}

void CoarseLink::add_children(const float* lobes, glm::ivec3 octant, const Exceptions* exceptions, float* out) const {
  for (int offset = 0; offset < kLobeLeafCells; ++offset) {
    const glm::ivec3 in_leaf(offset >> 6, (offset >> 3) & 7, offset & 7);
    const int to = leaf_offset(4 * octant + in_leaf / 2);
    const int child = ((in_leaf.x & 1) << 2) | ((in_leaf.y & 1) << 1) | (in_leaf.z & 1);
    if (exceptions != nullptr && ((exceptions->moved_out[size_t(to)] >> child) & 1) != 0) continue;
    for (int block = 0; block < coefficients_ * kLobeBands; ++block)
      out[block * kLobeLeafCells + to] += lobes[block * kLobeLeafCells + offset];
  }
}

void CoarseLink::add_moved(const LobeVolume& fine, const LobeKernels& kernels, const Moved& moved, float* out) const {
  if (glm::any(glm::greaterThanEqual(moved.from / kLeafCells, fine_blocks_))) return;  // beyond an odd grid
  float own[9 * kLobeBands];
  const float* lobe = own;
  if (moved.answer >= 0) {
    lobe = &answers_[size_t(moved.answer) * moved_floats()];
  } else {
    moved_lobe(fine, kernels, moved.from, own);
  }
  for (int band = 0; band < kLobeBands; ++band) {
    for (int k = 0; k < coefficients_; ++k) out[lobe_block(k, band) + moved.to] += lobe[k * kLobeBands + band];
  }
}

/// What a fine cell carries, by coefficient and band.
void CoarseLink::moved_lobe(const LobeVolume& fine, const LobeKernels& kernels, glm::ivec3 from, float* lobe) const {
  const float* lobes = fine.leaf(fine_numbers_.number(from / kLeafCells));
  const int at = leaf_offset(from);
  float carried[kLobeBands] = {};
  for (int face = 0; face < 6; ++face) {
    float power[kLobeBands][8];
    kernels.face_powers(lobes, face, at, 1, power);
    for (int band = 0; band < kLobeBands; ++band) carried[band] += power[band][0];
  }
  for (int band = 0; band < kLobeBands; ++band) {
    const float first = lobes[lobe_block(0, band) + at];
    for (int k = 0; k < coefficients_; ++k)
      lobe[k * kLobeBands + band] = first > 0.0f ? carried[band] / first * lobes[lobe_block(k, band) + at] : 0.0f;
  }
}

glm::dvec3 CoarseLink::spread(std::span<const glm::vec4> coarse_received, std::span<glm::vec4> received) const {
  std::vector<glm::vec4> known(coarse_received.begin(), coarse_received.end());
  known.resize(known_sides_);
  if (ranks_) coarse_halo_->fetch(known);
  std::vector<glm::vec4> stepped(shown_m2_.size()), even(shown_m2_.size());
  tbb::parallel_for(size_t(0), shares_.size(), [&](size_t i) {
    const Share& s = shares_[i];
    glm::vec3 power(0.0f);
    for (int k = 0; k < 3; ++k) {
      if (s.shares[k] > 0.0f) power += s.shares[k] * glm::vec3(known[size_t(s.sides[k])]);
    }
    stepped[i] = glm::vec4(power, 0.0f);
  });
  if (ranks_) fine_halo_->fetch(stepped);
  even_out(0, stepped, even);
  if (ranks_) fine_halo_->fetch(even);
  even_out(1, even, stepped);
  tbb::parallel_for(size_t(0), shares_.size(), [&](size_t i) { received[i] += stepped[i]; });
  std::array<ExactSum, 3> lost;
  for (const std::uint32_t j : alone_) {
    for (size_t band = 0; band < 3; ++band) lost[band].add(double(known[j][int(band)]));
  }
  return SideSums::over_ranks(lost, ranks_ ? &ranks_->fine.ranks : nullptr);
}

size_t CoarseLink::bytes() const {
  size_t sum =
      shares_.size() * (sizeof(Share) + sizeof(beside_[0]) + sizeof(shown_m2_[0])) + alone_.size() * sizeof(alone_[0]);
  for (const auto& e : exceptions_) sum += e ? e->moved_out.size() + e->moved_in.size() * sizeof(Moved) : 0;
  return sum;
}

}  // namespace volgi
