#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <cmath>
#include <glm/gtc/constants.hpp>

#include "voxel/slice_raster.h"

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

class BlockCells {
 public:
  BlockCells(const SlicedScene& s, std::uint32_t block, std::array<Cell, kBlockCells>& cells)
      : s_(s), first_cell_(s.block_cell(block)), cells_(cells) {}

  void add(const SliceTriangle& t) {
    if (t.normal == glm::vec3(0.0f)) return;
    if (t.nearest_axis == 0) slice<0>(t);
    if (t.nearest_axis == 1) slice<1>(t);
    if (t.nearest_axis == 2) slice<2>(t);
  }

  /// Leaves of the cells with a surface; all null when there is none. The cells are empty afterwards.
  Leaves collect();

 private:
  template <int axis>
  void slice(const SliceTriangle& t);

  const SlicedScene& s_;
  glm::ivec3 first_cell_;
  std::array<Cell, kBlockCells>& cells_;
};

template <int axis>
void BlockCells::slice(const SliceTriangle& t) {
  constexpr int b = axis == 2 ? 0 : axis + 1, c = axis == 0 ? 2 : axis - 1;
  const Long3 n = plane_normal(t);
  const glm::ivec3 last_cell = glm::min(first_cell_ + kLeafCells, s_.grid.cells) - 1;
  // Cells next to the grid's rim take what lies up to half a cell outside.
  const int rim = last_cell[axis] == s_.grid.cells[axis] - 1 ? 1 : 0;
  Window window{kFine * first_cell_[b],
                kFine * last_cell[b] + kFine - 1,
                kFine * first_cell_[c],
                kFine * last_cell[c] + kFine - 1,
                first_cell_[axis] == 0 ? -1 : kFine * first_cell_[axis],
                kFine * (last_cell[axis] + 1) + rim};
  if (!cut(window, fine_box(t), axis)) return;
  const double area_of_one = kUnit / (kFine * kFine * std::abs(double(t.normal[axis])));
  const TriangleMaterial material(s_, t, n, axis, kLineFootprint);
  const TriangleSlice<axis> triangle(t, n);
  triangle.fragments(window, [&](int column_b, int column_c, int, std::int64_t numerator) {
    glm::ivec3 cell;
    cell[b] = column_b / kFine;
    cell[c] = column_c / kFine;
    cell[axis] = std::clamp(int(std::floor(float(triangle.depth(numerator)))), 0, s_.grid.cells[axis] - 1);
    if (cell[axis] < first_cell_[axis] || cell[axis] > last_cell[axis]) return;
    const SlicedMaterial m = material.at(column_b, column_c);
    if (!(m.stopped > 0.0f)) return;
    Cell& to = cells_[size_t(leaf_offset(cell))];
    const double area = area_of_one * double(m.stopped);
    to.area += std::int64_t(area + 0.5);
    to.albedo += glm::i64vec3(area * glm::dvec3(m.albedo) + 0.5);
    to.normal += glm::i64vec3(glm::floor(area * glm::dvec3(t.normal) + 0.5));
    to.occupancy = std::max(to.occupancy, m.stopped);
    to.emission = glm::max(to.emission, glm::pi<float>() * m.emission);
  });
}

Leaves BlockCells::collect() {
  Leaves out;
  const openvdb::Coord origin(first_cell_.x, first_cell_.y, first_cell_.z);
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

CellVolumes make_cell_volumes(const SlicedScene& s) {
  std::vector<Leaves> leaves(s.occupied.size());
  using Cells = std::array<Cell, kBlockCells>;
  tbb::enumerable_thread_specific<std::unique_ptr<Cells>> scratch([] { return std::make_unique<Cells>(); });
  tbb::parallel_for(size_t(0), s.occupied.size(), [&](size_t i) {
    const std::uint32_t block = s.occupied[i];
    BlockCells cells(s, block, *scratch.local());
    for (std::uint32_t k = s.first[block]; k < s.first[block + 1]; ++k) cells.add(s.triangles[s.binned[k]]);
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
