#include <openvdb/openvdb.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <glm/gtc/constants.hpp>
#include <numeric>

#include "voxel/slice_internal.h"

namespace volgi::slicing {

namespace {

// A line off the column's centre may show a plane that passes the centre far away: it is kept where it is, so that "in
// front of the surface" is asked of the true plane.
constexpr double kFarthestDepth = 4096.0;

constexpr std::uint64_t kLastOfRow = 0x0101010101010101u;  // bit 8y

/// By face of the cells of one block: which have sides, and which stop everything.
struct CellFaces {
  std::array<BlockMask, 6> sided{};
  std::array<BlockMask, 6> opaque{};
};

/// Lower faces of the next cell along the axis, as upper faces of these.
BlockMask shifted_down(const BlockMask& own, const BlockMask& next, int axis) {
  BlockMask out;
  for (size_t x = 0; x < 8; ++x) {
    const std::uint64_t word = axis == 0 ? 0 : own[x], after = axis == 0 ? 0 : next[x];
    if (axis == 0) out[x] = x < 7 ? own[x + 1] : next[0];
    if (axis == 1) out[x] = word >> 8 | after << 56;
    if (axis == 2) out[x] = (word >> 1 & ~(kLastOfRow << 7)) | (after & kLastOfRow) << 7;
  }
  return out;
}

BlockMask inside_mask(const SlicedScene& s, glm::ivec3 first_cell) {
  const glm::ivec3 low = glm::clamp(s.first_cell - first_cell, 0, kLeafCells);
  const glm::ivec3 high = glm::clamp(s.last_cell - first_cell, 0, kLeafCells);
  const std::uint64_t row = ((std::uint64_t(1) << high.z) - 1) & ~((std::uint64_t(1) << low.z) - 1);
  BlockMask out{};
  for (int x = low.x; x < high.x; ++x) {
    for (int y = low.y; y < high.y; ++y) out[size_t(x)] |= row << (8 * y);
  }
  return out;
}

CellFaces cell_faces(const SlicedScene& s, const BlockTable& table, glm::ivec3 block) {
  static const BlockFaces kNone{};
  const auto faces_of = [&](glm::ivec3 at) -> const BlockFaces& {
    const auto& entry = table[s.window.index(at)];
    return entry ? *entry : kNone;
  };
  const BlockMask inside = inside_mask(s, kLeafCells * block);
  CellFaces out;
  const BlockFaces& own = faces_of(block);
  for (int axis = 0; axis < 3; ++axis) {
    const size_t a = size_t(axis);
    glm::ivec3 above = block;
    ++above[axis];
    const BlockFaces& next = above[axis] < s.window.last[axis] ? faces_of(above) : kNone;
    out.sided[2 * a] = own.sided[a];
    out.opaque[2 * a] = own.opaque[a];
    out.sided[2 * a + 1] = shifted_down(own.sided[a], next.sided[a], axis);
    out.opaque[2 * a + 1] = shifted_down(own.opaque[a], next.opaque[a], axis);
  }
  for (auto& mask : out.sided) {
    for (size_t x = 0; x < 8; ++x) mask[x] &= inside[x];
  }
  return out;
}

std::uint32_t side_count(const CellFaces& faces) {
  std::uint32_t count = 0;
  for (const BlockMask& mask : faces.sided) {
    for (std::uint64_t word : mask) count += std::uint32_t(std::popcount(word));
  }
  return count;
}

/// Fills the leaf's cells; sides are counted from `first`.
void fill_leaf(const CellFaces& faces, std::uint32_t first, VoxelGrid::Leaf& leaf) {
  std::int64_t* const cells = leaf.buffer().data();
  for (size_t x = 0; x < 8; ++x) {
    std::uint64_t any = 0;
    for (const BlockMask& mask : faces.sided) any |= mask[x];
    leaf.getValueMask().getWord<std::uint64_t>(openvdb::Index(x)) = any;
    for (; any != 0; any &= any - 1) {
      const int bit = std::countr_zero(any);
      std::uint32_t bits = 0;
      for (size_t face = 0; face < 6; ++face) {
        bits |= std::uint32_t(faces.sided[face][x] >> bit & 1u) << face;
        bits |= std::uint32_t(faces.opaque[face][x] >> bit & 1u) << (8 + face);
      }
      bits &= (bits & 63u) | (bits & 63u) << 8;
      cells[64 * x + size_t(bit)] = VoxelGrid::pack({first, bits});
      first += shared::count_bits(bits & 63u);
    }
  }
}

/// Writes the sides of a block's faces.
class SideWriter {
 public:
  SideWriter(const SlicedScene& s, const VoxelGrid& voxels, shared::Side* sides)
      : s_(s), voxels_(voxels), sides_(sides) {}

  void write(const FaceRecord& record, float coverage, int axis, glm::ivec3 face_cell) const {
    glm::ivec3 below = face_cell;
    --below[axis];
    const Seen low = surface(record.low_triangle, record.low_sub, axis, face_cell);
    const bool same = record.low_triangle == record.high_triangle && record.low_sub == record.high_sub;
    if (s_.gets_sides(below)) write_side(low, below, 2 * axis + 1, coverage);
    if (!s_.gets_sides(face_cell)) return;
    const Seen high = same ? low : surface(record.high_triangle, record.high_sub, axis, face_cell);
    write_side(high, face_cell, 2 * axis, coverage);
  }

 private:
  struct Seen {
    glm::vec3 normal, albedo, emission;
    float depth;
    bool double_sided;
  };

  Seen surface(std::uint32_t triangle, int sub, int axis, glm::ivec3 face_cell) const {
    const SliceTriangle& t = s_.triangles[triangle];
    const Long3 n = plane_normal(t);
    const int b = shared::axis_b(axis), c = shared::axis_c(axis);
    Seen out;
    // Rounding may tilt what the axis runs along to the other side.
    out.normal = t.normal;
    if (!(t.normal[axis] * float(n[size_t(axis)]) > 0.0f)) {
      out.normal = glm::vec3(glm::normalize(glm::dvec3(double(n[0]), double(n[1]), double(n[2]))));
    }
    const SlicedMaterial material = TriangleMaterial(s_, t, n, axis, kFaceFootprint)
                                        .at(kFine * face_cell[b] + sub % kFine, kFine * face_cell[c] + sub / kFine);
    out.albedo = material.albedo;
    out.emission = material.emission;
    out.double_sided = s_.material(t).double_sided;
    const double depth =
        plane_depth(t, n, axis, node_position(kFine * face_cell[b] + 1), node_position(kFine * face_cell[c] + 1));
    out.depth = float(std::clamp(depth, -kFarthestDepth, kFarthestDepth));
    return out;
  }

  void write_side(const Seen& seen, glm::ivec3 cell, int face, float coverage) const {
    const float h = s_.grid.cell_size_m;
    shared::Side side;
    // The cell looks along +face at the surface.
    const bool front = seen.normal[shared::face_axis(face)] * float(shared::face_sign(face)) < 0.0f;
    side.normal = front ? seen.normal : -seen.normal;
    side.coverage = coverage;
    side.albedo = seen.albedo;
    side.area_m2 = 0.0f;  // until it is counted
    side.radiosity = front || seen.double_sided ? glm::pi<float>() * seen.emission : glm::vec3(0.0f);
    side.face_m2 = coverage * h * h;
    side.cell = shared::cell_index(s_.grid, cell);
    side.face = face;
    side.depth = seen.depth;
    side.front = front ? 1 : 0;
    sides_[shared::side_index(voxels_.cell_sides(cell), face)] = side;
  }

  const SlicedScene& s_;
  const VoxelGrid& voxels_;
  shared::Side* sides_;
};

/// Of the held blocks: the part's own first, then those around it.
std::vector<glm::ivec3> blocks_in_order(const SlicedScene& s) {
  std::vector<glm::ivec3> blocks;
  blocks.reserve(s.held.count());
  for (const bool own : {true, false}) {
    for (size_t i = 0; i < s.held.count(); ++i) {
      if (s.part.contains(s.held.block(i)) == own) blocks.push_back(s.held.block(i));
    }
  }
  return blocks;
}

}  // namespace

VoxelGrid make_sides(const SlicedScene& s, const BlockTable& table) {
  const std::vector<glm::ivec3> blocks = blocks_in_order(s);
  const size_t count = blocks.size();
  const auto block_at = [&](size_t i) { return blocks[i]; };
  std::vector<std::uint32_t> first(count + 1, 0);  // side of each block
  tbb::parallel_for(size_t(0), count, [&](size_t i) { first[i + 1] = side_count(cell_faces(s, table, block_at(i))); });
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<VoxelGrid::Leaf*> leaves(count, nullptr);
  const auto make_leaves = [&] {
    tbb::parallel_for(size_t(0), count, [&](size_t i) {
      if (first[i] == first[i + 1]) return;
      const glm::ivec3 cell = kLeafCells * block_at(i);
      VoxelGrid::Leaf*& leaf = leaves[s.held.index(block_at(i))];
      leaf = new VoxelGrid::Leaf(openvdb::Coord(cell.x, cell.y, cell.z), 0);
      fill_leaf(cell_faces(s, table, block_at(i)), first[i], *leaf);
    });
  };
  std::vector<shared::Side> sides;
  tbb::parallel_invoke(make_leaves, [&] { sides.resize(first[count]); });
  VoxelGrid voxels(s.grid, std::move(sides), leaves, s.held, s.part, first[s.part.count()]);
  const SideWriter writer(s, voxels, voxels.mutable_sides().data());
  tbb::parallel_for(size_t(0), s.occupied.size(), [&](size_t i) {
    const BlockFaces* block = table[s.occupied[i]].get();
    if (block == nullptr) return;
    const glm::ivec3 first_cell = s.block_cell(s.occupied[i]);
    size_t face = 0;
    for (size_t axis = 0; axis < 3; ++axis) {
      for (size_t word = 0; word < 8; ++word) {
        for (std::uint64_t rest = block->active[axis][word]; rest != 0; rest &= rest - 1, ++face) {
          if (!(block->coverage[face] > 0.0f)) continue;
          const int bit = std::countr_zero(rest);
          writer.write(block->faces[face], block->coverage[face], int(axis),
                       first_cell + glm::ivec3(int(word), bit >> 3, bit & 7));
        }
      }
    }
  });
  return voxels;
}

}  // namespace volgi::slicing
