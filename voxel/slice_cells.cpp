#include <openvdb/openvdb.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <cmath>
#include <glm/gtc/constants.hpp>

#include "voxel/slice_internal.h"

namespace volgi::slicing {

namespace {

constexpr int kBlockCells = kLeafCells * kLeafCells * kLeafCells;
constexpr double kUnit = 1048576.0;  // of h^2; sums of integers do not depend on the order of triangles

struct Cell {
  std::int64_t area = 0;
  glm::i64vec3 albedo{0};  // times area
  glm::i64vec3 normal{0};
  float occupancy = 0.0f;
  glm::vec3 emission{0.0f};
};

struct Leaves {
  openvdb::FloatTree::LeafNodeType* occupancy = nullptr;
  openvdb::Vec3STree::LeafNodeType* albedo = nullptr;
  openvdb::Vec3STree::LeafNodeType* normal = nullptr;
  openvdb::Vec3STree::LeafNodeType* emission = nullptr;
};

/// Adds what a triangle has in cells.
class TriangleArea {
 public:
  TriangleArea(const SlicedScene& s, const SliceTriangle& t)
      : t_(t),
        n_(plane_normal(t)),
        // Where alpha varies, colours count as it does.
        material_(s, t, n_, t.nearest_axis, t.may_pass ? kLineFootprint : kFaceFootprint),
        area_of_one_(kUnit / (kFine * kFine * std::abs(double(t.normal[t.nearest_axis])))) {}

  /// @param cell  of the record.
  void add(const AreaRecord& record, const glm::ivec3& cell, Cell& to) const {
    const int b = cell[shared::axis_b(t_.nearest_axis)], c = cell[shared::axis_c(t_.nearest_axis)];
    const std::uint32_t subs = sub_columns(record);
    if (!t_.may_pass) return add(material_.at_cell(b, c), area_of_one_ * sub_count(subs), to);
    for (std::uint32_t rest = subs; rest != 0; rest &= rest - 1) {
      const int sub = std::countr_zero(rest);
      add(material_.at(kFine * b + sub % kFine, kFine * c + sub / kFine), area_of_one_, to);
    }
  }

 private:
  /// @param area  of the surface, whatever it stops.
  void add(const SlicedMaterial& m, double area, Cell& to) const {
    area *= double(m.stopped);
    to.area += std::int64_t(std::floor(area + 0.5));
    to.albedo += glm::i64vec3(area * glm::dvec3(m.albedo) + 0.5);
    to.normal += glm::i64vec3(glm::floor(area * glm::dvec3(t_.normal) + 0.5));
    to.occupancy = std::max(to.occupancy, m.stopped);
    to.emission = glm::max(to.emission, glm::pi<float>() * m.emission);
  }

  const SliceTriangle& t_;
  const Long3 n_;
  const TriangleMaterial material_;
  const double area_of_one_;
};

class BlockCells {
 public:
  BlockCells(const SlicedScene& s, glm::ivec3 block, std::array<Cell, kBlockCells>& cells)
      : s_(s), block_(block), cells_(cells) {}

  /// Takes those records that are of this block's cells. @param areas  of this block, or of one that is next along an
  /// axis: its fragments may lie half a cell below it. @param their_block  which block they are of.
  void add(const std::vector<AreaRecord>& areas, glm::ivec3 their_block);

  /// Leaves of the cells with a surface; all null when there is none. The cells are empty afterwards.
  Leaves collect();

 private:
  const SlicedScene& s_;
  glm::ivec3 block_;
  std::array<Cell, kBlockCells>& cells_;
};

void BlockCells::add(const std::vector<AreaRecord>& areas, glm::ivec3 their_block) {
  std::uint32_t triangle = 0;
  std::optional<TriangleArea> of_triangle;
  for (const AreaRecord& record : areas) {
    // What lies up to half a cell outside belongs to the grid's outermost cells.
    const glm::ivec3 seen = kLeafCells * their_block + unpack_cell(record.cell);
    const glm::ivec3 cell = glm::clamp(seen, glm::ivec3(0), s_.grid.cells - 1);
    if ((cell >> kLeafShift) != block_) continue;
    if (!of_triangle || record.triangle != triangle) of_triangle.emplace(s_, s_.triangles[record.triangle]);
    triangle = record.triangle;
    of_triangle->add(record, seen, cells_[size_t(leaf_offset(cell))]);
  }
}

Leaves BlockCells::collect() {
  Leaves out;
  const glm::ivec3 first_cell = kLeafCells * block_;
  const openvdb::Coord origin(first_cell.x, first_cell.y, first_cell.z);
  for (size_t i = 0; i < cells_.size(); ++i) {
    Cell& cell = cells_[i];
    if (cell.area == 0) continue;
    if (out.occupancy == nullptr) {
      const openvdb::Vec3s zero(0.0f);
      out.occupancy = new openvdb::FloatTree::LeafNodeType(origin, 0.0f);
      out.albedo = new openvdb::Vec3STree::LeafNodeType(origin, zero);
      out.normal = new openvdb::Vec3STree::LeafNodeType(origin, zero);
      out.emission = new openvdb::Vec3STree::LeafNodeType(origin, zero);
    }
    const auto offset = openvdb::Index(i);
    const double area = double(cell.area);
    const glm::dvec3 albedo = glm::dvec3(cell.albedo) / area;
    glm::dvec3 normal(cell.normal);
    const double length = glm::length(normal);
    normal = length < 1e-3 * area ? glm::dvec3(0.0) : normal / length;
    out.occupancy->setValueOn(offset, cell.occupancy);
    out.albedo->setValueOn(offset, openvdb::Vec3s(openvdb::Vec3d(albedo.x, albedo.y, albedo.z)));
    out.normal->setValueOn(offset, openvdb::Vec3s(openvdb::Vec3d(normal.x, normal.y, normal.z)));
    out.emission->setValueOn(offset, openvdb::Vec3s(cell.emission.x, cell.emission.y, cell.emission.z));
    cell = Cell{};
  }
  return out;
}

}  // namespace

CellVolumes make_cell_volumes(const SlicedScene& s, const BlockTable& areas) {
  const size_t count = s.part.count();
  std::vector<Leaves> leaves(count);
  using Cells = std::array<Cell, kBlockCells>;
  tbb::enumerable_thread_specific<std::unique_ptr<Cells>> scratch([] { return std::make_unique<Cells>(); });
  tbb::parallel_for(size_t(0), count, [&](size_t i) {
    const glm::ivec3 block = s.part.block(i);
    BlockCells cells(s, block, *scratch.local());
    const auto areas_of = [&](glm::ivec3 at) { return areas[s.window.index(at)].get(); };
    if (const BlockFaces* own = areas_of(block)) cells.add(own->areas, block);
    for (int axis = 0; axis < 3; ++axis) {
      glm::ivec3 above = block;
      if (++above[axis] >= s.window.last[axis]) continue;
      const BlockFaces* there = areas_of(above);
      const bool outside = kLeafCells * above[axis] >= s.grid.cells[axis];
      if (there != nullptr && (outside || there->areas_below[size_t(axis)])) cells.add(there->areas, above);
    }
    leaves[i] = cells.collect();
  });
  CellVolumes out = empty_cell_volumes(s.grid, s.scene->world_origin);
  for (const Leaves& l : leaves) {
    if (l.occupancy == nullptr) continue;
    out.occupancy->tree().addLeaf(l.occupancy);
    out.albedo->tree().addLeaf(l.albedo);
    out.normal->tree().addLeaf(l.normal);
    out.emission->tree().addLeaf(l.emission);
  }
  return out;
}

}  // namespace volgi::slicing
