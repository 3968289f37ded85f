#include "voxel/grid_faces.h"

#include <openvdb/openvdb.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <span>

namespace volgi {

namespace {

constexpr std::uint8_t kStopsAll = 255;

/// What lets a trace of light pass does not count as stopping everything, nor the other way round.
std::uint8_t coverage_byte(float coverage) {
  if (coverage >= 1.0f) return kStopsAll;
  return std::uint8_t(std::clamp(int(std::lround(coverage * 255.0f)), 0, 254));
}

/// In 0 ... 254, for one ray at one face. The finalizer of MurmurHash3.
std::uint32_t byte_hash(std::uint32_t seed, std::uint32_t cell, int face) {
  std::uint32_t h = seed * 0x9e3779b9u + cell * 6u + std::uint32_t(face);
  h = (h ^ (h >> 16)) * 0x85ebca6bu;
  h = (h ^ (h >> 13)) * 0xc2b2ae35u;
  h ^= h >> 16;
  return std::uint32_t((std::uint64_t(h) * kStopsAll) >> 32);
}

/// A box in cell units that a ray goes through.
struct Way {
  glm::vec3 origin, direction;

  float to_plane(int axis, int cell) const { return (float(cell) - origin[axis]) / direction[axis]; }
  /// Where it leaves the box of cells, and across which axis.
  float leaves(glm::ivec3 first, glm::ivec3 last, int& axis) const {
    float t = std::numeric_limits<float>::infinity();
    axis = -1;
    for (int a = 0; a < 3; ++a) {
      if (direction[a] == 0.0f) continue;
      const float at = to_plane(a, direction[a] > 0.0f ? last[a] : first[a]);
      if (at < t) t = at, axis = a;
    }
    return t;
  }
  /// Of the cells first ... last - 1, the one where it is after `t`.
  glm::ivec3 cell_at(float t, glm::ivec3 first, glm::ivec3 last) const {
    return glm::clamp(glm::ivec3(glm::floor(origin + t * direction)), first, last - 1);
  }
};

template <class T>
void put(std::vector<std::byte>& to, const std::vector<T>& values) {
  const auto count = std::uint64_t(values.size());
  const size_t at = to.size();
  to.resize(at + sizeof count + count * sizeof(T));
  std::memcpy(to.data() + at, &count, sizeof count);
  if (count > 0) std::memcpy(to.data() + at + sizeof count, values.data(), count * sizeof(T));
}

template <class T>
std::vector<T> take(std::span<const std::byte>& from) {
  std::uint64_t count = 0;
  std::memcpy(&count, from.data(), sizeof count);
  std::vector<T> values(count);
  if (count > 0) std::memcpy(values.data(), from.data() + sizeof count, count * sizeof(T));
  from = from.subspan(sizeof count + count * sizeof(T));
  return values;
}

}  // namespace

GridFaces::GridFaces(const VoxelGrid& voxels)
    : grid_(voxels.grid()), blocks_(voxels.blocks()), block_of_(size_t(blocks_.x) * blocks_.y * blocks_.z, -1) {
  add(voxels);
}

GridFaces::GridFaces(const VoxelGrid& voxels, const RanksOfVolume& ranks) : GridFaces(voxels) {
  const std::vector<std::byte> own = packed();
  with_sides_.clear();
  block_numbers_.clear();
  cells_.clear();
  coverage_.clear();
  // In the order of ranks: places in memory differ from one rank's, what a ray meets does not.
  for (const auto& from : ranks.ranks.exchange(std::vector<Ranks::Bytes>(size_t(ranks.ranks.count()), own)))
    append(from);
}

/// The sides of its own part.
void GridFaces::add(const VoxelGrid& voxels) {
  const BlockBox& part = voxels.part();
  for (size_t i = 0; i < part.count(); ++i) {
    const VoxelGrid::Leaf* leaf = voxels.leaf(part.block(i));
    if (leaf == nullptr) continue;
    const std::int64_t* cells = leaf->buffer().data();
    Block block;
    block.first_cell = std::uint32_t(cells_.size());
    block.first_side = std::uint32_t(coverage_.size());
    for (size_t c = 0; c < kLeafVolume; ++c) {
      const glm::uvec2 own = VoxelGrid::unpack(cells[c]);
      const std::uint32_t faces = own.y & 63u;
      if (faces == 0) continue;
      block.cells[c / 64] |= std::uint64_t(1) << (c % 64);
      cells_.push_back({std::uint16_t(coverage_.size() - block.first_side), std::uint8_t(faces)});
      for (std::uint32_t s = own.x; s < own.x + shared::count_bits(faces); ++s)
        coverage_.push_back(coverage_byte(voxels.sides()[s].coverage));
    }
    const int number = block_index(blocks_, part.block(i));
    block_of_[size_t(number)] = std::int32_t(with_sides_.size());
    block_numbers_.push_back(number);
    with_sides_.push_back(block);
  }
}

std::vector<std::byte> GridFaces::packed() const {
  std::vector<std::byte> bytes;
  put(bytes, block_numbers_);
  put(bytes, with_sides_);
  put(bytes, cells_);
  put(bytes, coverage_);
  return bytes;
}

void GridFaces::append(std::span<const std::byte> from) {
  const auto numbers = take<std::int32_t>(from);
  const auto blocks = take<Block>(from);
  const auto cells = take<Cell>(from);
  const auto coverage = take<std::uint8_t>(from);
  for (size_t i = 0; i < blocks.size(); ++i) {
    block_of_[size_t(numbers[i])] = std::int32_t(with_sides_.size());
    Block block = blocks[i];
    block.first_cell += std::uint32_t(cells_.size());
    block.first_side += std::uint32_t(coverage_.size());
    with_sides_.push_back(block);
  }
  block_numbers_.insert(block_numbers_.end(), numbers.begin(), numbers.end());
  cells_.insert(cells_.end(), cells.begin(), cells.end());
  coverage_.insert(coverage_.end(), coverage.begin(), coverage.end());
}

bool GridFaces::stops(const Block& block, glm::ivec3 cell, int face, std::uint32_t seed) const {
  const int place = leaf_offset(cell), word = place / 64;
  const std::uint64_t bit = std::uint64_t(1) << (place % 64);
  if ((block.cells[size_t(word)] & bit) == 0) return false;
  auto before = std::uint32_t(std::popcount(block.cells[size_t(word)] & (bit - 1)));
  for (int w = 0; w < word; ++w) before += std::uint32_t(std::popcount(block.cells[size_t(w)]));
  const Cell& c = cells_[block.first_cell + before];
  if ((c.faces >> face & 1) == 0) return false;
  const std::uint32_t side = block.first_side + c.first_side + shared::count_bits(c.faces & ((1u << face) - 1u));
  const std::uint8_t coverage = coverage_[side];
  return coverage == kStopsAll || byte_hash(seed, std::uint32_t(shared::cell_index(grid_, cell)), face) < coverage;
}

bool GridFaces::meet(glm::vec3 origin, glm::vec3 direction, std::uint32_t seed, Hit& hit) const {
  const Way way{origin, direction};
  float t = 0.0f;
  int entry = -1;  // axis across which it comes into the grid; -1: it begins there
  for (int a = 0; a < 3; ++a) {
    const bool outside = direction[a] > 0.0f ? origin[a] < 0.0f : origin[a] > float(grid_.cells[a]);
    if (direction[a] == 0.0f && (origin[a] < 0.0f || origin[a] > float(grid_.cells[a]))) return false;
    if (direction[a] == 0.0f || !outside) continue;
    const float at = way.to_plane(a, direction[a] > 0.0f ? 0 : grid_.cells[a]);
    if (at > t) t = at, entry = a;
  }
  const glm::vec3 enters = origin + t * direction;
  constexpr float kRounding = 1e-3f;  // cells
  if (glm::any(glm::lessThan(enters, glm::vec3(-kRounding))) ||
      glm::any(glm::greaterThan(enters, glm::vec3(grid_.cells) + kRounding)))
    return false;
  glm::ivec3 cell = way.cell_at(t, glm::ivec3(0), grid_.cells);
  if (entry >= 0) {  // a wall on the rim, whose outside has no side
    const std::int32_t index = block_of_[size_t(block_index(blocks_, cell >> kLeafShift))];
    const int face = 2 * entry + (direction[entry] > 0.0f ? 0 : 1);
    if (index >= 0 && stops(with_sides_[size_t(index)], cell, face, seed)) return false;
  }
  while (shared::cell_inside(grid_, cell)) {
    const glm::ivec3 number = cell >> kLeafShift;
    const std::int32_t index = block_of_[size_t(block_index(blocks_, number))];
    const glm::ivec3 first = index < 0 ? kLeafCells * number : cell;
    const glm::ivec3 last = index < 0 ? glm::min(first + kLeafCells, grid_.cells) : cell + 1;
    int axis = 0;
    t = way.leaves(first, last, axis);
    if (axis < 0) return false;
    const int face = 2 * axis + (direction[axis] > 0.0f ? 1 : 0);
    if (index >= 0 && stops(with_sides_[size_t(index)], cell, face, seed)) {
      hit = {cell, face, t};
      return true;
    }
    if (index < 0) cell = way.cell_at(t, first, last);  // the last one in the block
    cell[axis] = direction[axis] > 0.0f ? last[axis] : first[axis] - 1;
  }
  return false;
}

size_t GridFaces::bytes() const {
  return block_of_.size() * sizeof(block_of_[0]) + with_sides_.size() * (sizeof(Block) + sizeof(block_numbers_[0])) +
         cells_.size() * sizeof(Cell) + coverage_.size();
}

}  // namespace volgi
