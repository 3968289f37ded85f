#pragma once
// Parts of the CPU's sliced voxelization, shared by voxelize_cpu.cpp and its neighbours; not for other rooms.
#include <array>
#include <atomic>
#include <bit>
#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/type_precision.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "core/mipmaps.h"
#include "core/scene.h"
#include "voxel/cell_volumes.h"
#include "voxel/voxel_grid.h"

namespace volgi::slicing {

// The lattice of fine columns and nodes, three to a cell: node k lies at (2k+1) * kNodeStep/2 steps of slice_vertex.
constexpr int kFine = 3;
constexpr int kNodeShift = 7;
constexpr std::int64_t kNodeStep = 1 << kNodeShift;
constexpr std::int64_t kHalfNodeStep = kNodeStep / 2;
static_assert(kFine * kNodeStep == SLICE_STEPS);
constexpr std::int64_t node_position(std::int64_t k) { return k * kNodeStep + kHalfNodeStep; }

/// Around a rank's part, in cells, sides are known too: as far as counting areas and light that is put down look.
constexpr int kSidesKnownAround = kLeafCells - 1;

constexpr float kOpaque = 0.999f;  // a share as large as this stops everything (slice.frag.glsl)

using Long3 = std::array<std::int64_t, 3>;

struct SliceTriangle {
  std::array<glm::ivec3, 3> vertex;  // slice_vertex
  glm::vec3 normal;                  // unit, of the front, before rounding; zero without area
  std::uint32_t mesh;
  std::uint32_t triangle;                               // of the mesh
  std::array<std::uint8_t, 3> first_block, last_block;  // that may hold fragments; first.x > last.x: none
  std::uint8_t nearest_axis;                            // of the normal: along it the triangle's area is counted
  bool may_pass;                                        // alpha decides what it stops
};

/// Normal of the rounded triangle, twice its area long.
inline Long3 plane_normal(const SliceTriangle& t) {
  const glm::i64vec3 u(t.vertex[1] - t.vertex[0]), v(t.vertex[2] - t.vertex[0]);
  return {u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
}

/// What a surface is made of. What alpha means is already decided: the share of light that is stopped.
struct SlicedMaterial {
  glm::vec3 albedo;
  glm::vec3 emission;  // L_e
  float stopped;
};

/// Fine columns on each axis that the triangle's bounds hold; empty where first > last.
struct FineBox {
  glm::ivec3 first, last;
};
inline FineBox fine_box(const SliceTriangle& t) {
  const glm::ivec3 low = glm::min(glm::min(t.vertex[0], t.vertex[1]), t.vertex[2]);
  const glm::ivec3 high = glm::max(glm::max(t.vertex[0], t.vertex[1]), t.vertex[2]);
  constexpr int kHalf = int(kHalfNodeStep);
  return {(low - kHalf + int(kNodeStep) - 1) >> kNodeShift, (high - kHalf) >> kNodeShift};
}

/// The scene's triangles in the order that the GPU numbers them (by material, then as in the file), and which of them
/// may have fragments in which block of 8^3 cells. Faces belong to the block of their upper cell, so that there is one
/// layer of blocks more than cells need where the cells fill their last block. A rank among several has a window of the
/// blocks: its part and those around, of which `held` get sides, all but their outermost layer of cells, for whose
/// faces coverage would look outside.
struct SlicedScene {
  const Scene* scene = nullptr;
  const Mipmaps* mipmaps = nullptr;
  Grid grid{};
  BlockBox part, held, window;
  glm::ivec3 first_cell{0}, last_cell{0};  // that get sides; the last one not among them
  std::vector<SliceTriangle> triangles;    // that meet the window
  size_t triangle_count = 0;               // of the scene
  std::vector<std::uint32_t> first;        // of `binned`, by block of the window; one more at the end
  std::vector<std::uint32_t> binned;       // triangles
  std::vector<std::uint32_t> occupied;     // blocks with triangles, ascending

  std::vector<std::optional<SlicedMaterial>> constant;  // by mesh: where no texture or vertex colour varies it

  const Mesh& mesh(const SliceTriangle& t) const { return scene->meshes[t.mesh]; }
  const Material& material(const SliceTriangle& t) const { return scene->materials[size_t(mesh(t).material)]; }
  glm::ivec3 block_cell(std::uint32_t block) const { return kLeafCells * window.block(block); }
  bool gets_sides(glm::ivec3 cell) const {
    return glm::all(glm::greaterThanEqual(cell, first_cell)) && glm::all(glm::lessThan(cell, last_cell));
  }
};
/// The scene and its mipmaps must outlive what is returned. @param part  of the grid's blocks; all of them: no ranks.
SlicedScene slice_scene(const Scene& scene, const Grid& grid, const Mipmaps& mipmaps, const BlockBox& part);
SlicedScene slice_scene(const Scene& scene, const Grid& grid, const Mipmaps& mipmaps);

// Edge in cells of the square that a texel should stand for: alpha belongs to a fine line, albedo to a face.
constexpr float kLineFootprint = 1.0f / kFine;
constexpr float kFaceFootprint = 1.0f;

/// By mesh: where no texture or vertex colour varies it.
std::vector<std::optional<SlicedMaterial>> constant_materials(const Scene& scene);

/// What a triangle is made of at the fine columns of the pass along `axis`.
class TriangleMaterial {
 public:
  /// @param n  plane_normal(t); @param footprint  cells, on an edge. All must outlive this.
  TriangleMaterial(const SlicedScene& s, const SliceTriangle& t, const Long3& n, int axis, float footprint);
  SlicedMaterial at(int fine_b, int fine_c) const;
  /// At the middle column of a cell, or where the triangle is nearest to it by its weights: one answer for a cell.
  SlicedMaterial at_cell(int cell_b, int cell_c) const;

 private:
  SlicedMaterial at(const glm::vec3& weights) const;
  glm::vec4 texel(const TextureUse& use, const glm::vec3& weights, float lod, bool srgb) const;

  const SlicedScene& s_;
  const SliceTriangle& t_;
  const Long3& n_;
  int axis_;
  const SlicedMaterial* constant_ = nullptr;
  glm::uvec3 corners_{0};
  float base_lod_ = 0.0f, metallic_lod_ = 0.0f, emissive_lod_ = 0.0f;
};

/// Depth of the triangle's plane along `axis` in cell units, where the column's coordinates are `position` (in steps).
inline double plane_depth(const SliceTriangle& t, const Long3& n, int axis, std::int64_t position_b,
                          std::int64_t position_c) {
  const int b = shared::axis_b(axis), c = shared::axis_c(axis);
  const std::int64_t numerator = n[size_t(axis)] * t.vertex[0][axis] - n[size_t(b)] * (position_b - t.vertex[0][b]) -
                                 n[size_t(c)] * (position_c - t.vertex[0][c]);
  return double(numerator) / (double(n[size_t(axis)]) * SLICE_STEPS);
}

/// A face that a surface touches.
struct FaceRecord {
  std::uint32_t fine_blocked;      // bit 9 part + sub_b + 3 sub_c: parts of the nine finer lines that are blocked
  std::uint32_t alpha_sum;         // of -ln(1 - alpha), 2^-16
  std::uint32_t low_triangle;      // nearest to the cell below
  std::uint32_t high_triangle;     // nearest to the cell above
  std::uint8_t low_sub, high_sub;  // sub-columns of their fragments, sub_b + 3 sub_c
};

/// Fragments of one triangle in one cell, in the pass along the axis nearest to its normal.
struct AreaRecord {
  std::uint32_t triangle;
  std::uint32_t cell;    // pack_cell, from the block's first one: fragments may lie half a cell below it
  std::uint32_t amount;  // bits 0-8 the sub-columns, the rest the sum of what they stop, 2^-16
  float depth;           // of the first of them, cell units
};
constexpr int kStoppedShift = 9;
constexpr float kStoppedUnit = 65536.0f;
/// Numbers of sub-columns in nine bits; baseline x86-64 has no instruction for it.
constexpr auto kSubCounts = [] {
  std::array<std::uint8_t, 1 << kStoppedShift> count{};
  for (size_t i = 1; i < count.size(); ++i) count[i] = std::uint8_t(count[i / 2] + i % 2);
  return count;
}();
inline std::uint32_t sub_columns(const AreaRecord& r) { return r.amount & ((1u << kStoppedShift) - 1); }
inline std::uint32_t sub_count(std::uint32_t sub_columns) { return kSubCounts[sub_columns]; }
inline std::uint32_t pack_cell(glm::ivec3 from_first) {  // -1 ... 8 on each axis
  return std::uint32_t(from_first.x + 1) | std::uint32_t(from_first.y + 1) << 4 | std::uint32_t(from_first.z + 1) << 8;
}
inline glm::ivec3 unpack_cell(std::uint32_t v) { return glm::ivec3(v & 15u, (v >> 4) & 15u, (v >> 8) & 15u) - 1; }

/// One bit for each cell of a block, in the order of leaf_offset: word x, bit 8y + z.
using BlockMask = std::array<std::uint64_t, 8>;

struct BlockFaces {
  std::array<BlockMask, 3> active{};  // by axis: lower faces of the cells that have a record
  std::array<std::array<std::uint16_t, 8>, 3> rank{};
  std::array<BlockMask, 3> sided{};   // of these, faces that have sides
  std::array<BlockMask, 3> opaque{};  // and that stop everything
  std::vector<FaceRecord> faces;
  std::vector<float> coverage;  // by face
  std::vector<AreaRecord> areas;
  std::array<bool, 3> areas_below{};  // by axis: some lie in the cells below the block

  int face(int axis, int offset) const {
    const size_t a = size_t(axis), word = size_t(offset >> 6);
    const std::uint64_t bit = std::uint64_t(1) << (offset & 63);
    if ((active[a][word] & bit) == 0) return -1;
    return rank[a][word] + std::popcount(active[a][word] & (bit - 1));
  }
};

/// Blocks by index; null where no surface is.
using BlockTable = std::vector<std::unique_ptr<BlockFaces>>;

/// Rasterizes every block: which faces are touched by which surfaces.
BlockTable mark_faces(const SlicedScene& s);

/// Coverage of all faces, from the nodes of the fine lattice that light can reach (docs/theory.md#voxelization).
void cover_faces(const SlicedScene& s, BlockTable& table);

/// Sides of all covered faces, their areas still zero.
VoxelGrid make_sides(const SlicedScene& s, const BlockTable& table);

/// What the part's surfaces give to each side of voxels.sides(), in units of h^2 / 2^20: sums of integers, so that
/// neither threads nor ranks matter.
std::vector<std::uint32_t> count_areas(const SlicedScene& s, const BlockTable& table, const VoxelGrid& voxels);
/// Gives sides the area of the surface that they stand for.
void set_areas(const std::vector<std::uint32_t>& counted, VoxelGrid& voxels);

/// The blocks' areas alone, as mark_faces counts them.
BlockTable list_areas(const SlicedScene& s);

/// What cells hold of the surfaces in them. @param areas  mark_faces or list_areas.
CellVolumes make_cell_volumes(const SlicedScene& s, const BlockTable& areas);

}  // namespace volgi::slicing
