#include "voxel/side_search.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace volgi {

namespace {

/// shared::face_of_depth in integers, where baseline x86-64 has no instruction for floor.
int face_of_depth(float depth) {
  const float scaled = depth * 8192.0f + 0.5f;
  const int truncated = int(scaled);
  return (truncated - (float(truncated) > scaled ? 1 : 0) + 4096) >> 13;
}

/// Numbers of bits of 0 ... 31.
constexpr std::array<std::uint8_t, 32> kBitCount = [] {
  std::array<std::uint8_t, 32> count{};
  for (size_t i = 1; i < count.size(); ++i) count[i] = std::uint8_t(count[i / 2] + i % 2);
  return count;
}();

constexpr float kLikeNormals = 0.70710678f;  // within 45 degrees
constexpr float kOneLayer = 0.02f;           // cells: layers nearer than this count as one
constexpr float kFarthest = 3.0f;            // cells along the axis

/// Whether a surface whose plane passes the column's centre at `depth` lies behind the one that the side shows, by more
/// than the two can part within half the diagonal of a face when they are one bent surface.
bool behind_side(const shared::Side& side, glm::vec3 normal, int axis, float depth) {
  const float behind = (side.depth - depth) * side.normal[axis];
  if (!(behind > kOneLayer)) return false;
  const float cosine = glm::clamp(glm::dot(side.normal, normal), 0.1f, 1.0f);
  const float bend = std::sqrt(1.0f - cosine * cosine) / cosine;
  return behind > kOneLayer + 0.75f * bend;
}

}  // namespace

SideColumns::SideColumns(const VoxelGrid& voxels) {
  const glm::ivec3 cells = voxels.grid().cells;
  for (int axis = 0; axis < 3; ++axis) {
    const int stride = voxels.blocks()[axis] + 2 * kPad;
    layout_[size_t(axis)] = {stride, cells[shared::axis_b(axis)], cells[shared::axis_c(axis)]};
  }
  std::vector<const VoxelGrid::Leaf*> leaves;
  voxels.cell_sides_tree().getNodes(leaves);
  tbb::parallel_for(0, 12, [&](int kind) {
    const Layout& l = layout_[size_t(kind % 6 / 2)];
    columns_[size_t(kind)].assign(size_t(l.stride) * size_t(l.columns_b) * size_t(l.columns_c) + sizeof(std::uint32_t),
                                  0);
  });
  tbb::parallel_for(size_t(0), leaves.size(), [&](size_t i) { fill(voxels, *leaves[i]); });
  tbb::parallel_for(0, 12, [&](int kind) { spread(kind); });
}

/// A leaf is one byte of each of its columns.
void SideColumns::fill(const VoxelGrid& voxels, const VoxelGrid::Leaf& leaf) {
  const glm::ivec3 origin(leaf.origin().x(), leaf.origin().y(), leaf.origin().z());
  for (auto it = leaf.cbeginValueOn(); it; ++it) {
    const int offset = int(it.pos());
    const glm::ivec3 local(offset >> 6, offset >> 3 & 7, offset & 7);
    const glm::ivec3 cell = origin + local;
    const glm::uvec2 own = VoxelGrid::unpack(*it);
    size_t side = own.x;
    for (int face = 0; face < 6; ++face) {
      if (!shared::has_side(own, face)) continue;
      const int axis = shared::face_axis(face), front = voxels.sides()[side++].front;
      std::uint8_t& to =
          columns_[size_t(face + 6 * front)][byte(face, cell[shared::axis_b(axis)], cell[shared::axis_c(axis)]) +
                                             size_t(origin[axis] >> kLeafShift)];
      to = std::uint8_t(to | 1u << local[axis]);
    }
  }
}

void SideColumns::spread(int kind) {
  const Layout& l = layout_[size_t(kind % 6 / 2)];
  const size_t column = size_t(l.stride), row = column * size_t(l.columns_b);
  // Columns at the end of a row look at the next row's first, too: it can only ask for a search more.
  const auto with_neighbours = [](const Bytes& in, size_t step) {
    Bytes out = in;
    const size_t size = in.size();
    for (size_t i = 0; i + step < size; ++i) out[i] = std::uint8_t(out[i] | in[i + step]);
    for (size_t i = step; i < size; ++i) out[i] = std::uint8_t(out[i] | in[i - step]);
    return out;
  };
  around_[size_t(kind)] = with_neighbours(with_neighbours(columns_[size_t(kind)], column), row);
}

SideSearch::SideSearch(const VoxelGrid& voxels, const SideColumns* columns, glm::vec3 normal, int front, bool both)
    : voxels_(voxels), columns_(columns), normals_{normal, -normal}, fronts_{front, 1 - front}, ways_(both ? 2 : 1) {
  for (int axis = 0; axis < 3; ++axis) {
    Axis& a = axes_[axis];
    a.slope_b = normal[shared::axis_b(axis)] / normal[axis];
    a.slope_c = normal[shared::axis_c(axis)] / normal[axis];
    a.slope = std::abs(a.slope_b) + std::abs(a.slope_c);
    // Where the normal runs up the axis, the cells above the surface see it; they have it at their lower face.
    const bool up = normal[axis] > 0.0f;
    a.faces[0] = shared::face_of(axis, !up);
    a.faces[1] = shared::face_of(axis, up);
    a.below[0] = up ? 0 : 1;
    a.below[1] = up ? 1 : 0;
    for (int way = 0; columns != nullptr && way < ways_; ++way) {
      a.columns[way] = columns->of_face(a.faces[way], fronts_[way]);
    }
  }
}

/// Bits of the cells `first` ... `first` + 2 of a column that have a side on the face.
std::uint32_t SideSearch::cells_with_side(int face, int b, int c, int first) const {
  const int axis = shared::face_axis(face);
  glm::ivec3 cell;
  cell[shared::axis_b(axis)] = b;
  cell[shared::axis_c(axis)] = c;
  std::uint32_t bits = 0;
  for (int k = 0; k < 3; ++k) {
    cell[axis] = first + k;
    if (cell[axis] < 0 || cell[axis] >= voxels_.grid().cells[axis]) continue;
    bits |= std::uint32_t(shared::has_side(voxels_.cell_sides(cell), face)) << k;
  }
  return bits;
}

/// Looks at the sides of a column: at the face of the plane first, then at those beside it. True when one is alike.
template <int axis>
inline bool SideSearch::look(const Column& column, int way, Found& found) const {
  const Axis& a = axes_[axis];
  const int face = a.faces[way];
  const int middle = column.face - a.below[way];
  const std::uint32_t three = columns_ != nullptr ? a.columns[way].column(column.b, column.c, middle - 1) & 7u
                                                  : cells_with_side(face, column.b, column.c, middle - 1);
  if (three == 0) return false;
  glm::ivec3 cell;
  cell[(axis + 1) % 3] = column.b;
  cell[(axis + 2) % 3] = column.c;
  for (int step : {0, 1, -1}) {
    if ((three >> (step + 1) & 1u) == 0) continue;
    cell[axis] = middle + step;
    const glm::uvec2 own = voxels_.cell_sides(cell);
    const std::uint32_t index = own.x + kBitCount[own.y & ((1u << face) - 1u)];
    const shared::Side& side = voxels_.sides()[index];
    const int front = fronts_[way];
    const glm::vec3 normal = normals_[way];
    if (front >= 0 && (side.front != front || behind_side(side, normal, axis, column.depth))) continue;
    const float cosine = glm::dot(side.normal, normal);
    if (!(cosine >= 0.0f)) continue;
    if (found.facing < 0) {
      found.facing_varies |= !column.all_near;
      if (column.near) found.facing = int(index);
    }
    if (!(cosine >= kLikeNormals)) continue;
    found.alike_varies |= !column.all_near;
    if (!column.near) continue;
    found.alike = int(index);
    return true;
  }
  return false;
}

/// Ways for which one of the nine columns around has a side that the plane might ask for.
int SideSearch::anybody_around(int axis, const Column& own) const {
  const Axis& a = axes_[axis];
  if (columns_ == nullptr) return 3;
  const float slope = a.slope > 0.0f ? a.slope + 1e-3f : 0.0f;  // rounding
  const int first = face_of_depth(own.depth - slope) - 1, last = face_of_depth(own.depth + slope) + 1;
  const std::uint32_t mask = (1u << (last - first + 1)) - 1;
  int ways = 0;
  for (int way = 0; way < ways_; ++way) {
    const std::uint32_t bits = a.columns[way].around(own.b, own.c, first - a.below[way]);
    if ((bits & mask) != 0) ways |= 1 << way;
  }
  return ways;
}

/// The quick way to what most searches end with: the plane's own face has the side asked for.
template <int axis>
inline int SideSearch::side_at_once(const Column& column, int way) const {
  const Axis& a = axes_[axis];
  glm::ivec3 cell;
  cell[(axis + 1) % 3] = column.b;
  cell[(axis + 2) % 3] = column.c;
  cell[axis] = column.face - a.below[way];
  if (cell[axis] < 0 || cell[axis] >= voxels_.grid().cells[axis]) return -1;
  const glm::uvec2 own = voxels_.cell_sides(cell);
  if (!shared::has_side(own, a.faces[way])) return -1;
  const std::uint32_t index = own.x + kBitCount[own.y & ((1u << a.faces[way]) - 1u)];
  const shared::Side& side = voxels_.sides()[index];
  const bool good = (side.front == fronts_[way] || fronts_[way] < 0) &&
                    (fronts_[way] < 0 || (side.depth - column.depth) * side.normal[axis] <= kOneLayer) &&
                    glm::dot(side.normal, normals_[way]) >= kLikeNormals;
  return good ? int(index) : -1;
}

template <int axis>
void SideSearch::find(glm::vec3 point, glm::ivec3 own, Found* found) const {
  constexpr int b = (axis + 1) % 3, c = (axis + 2) % 3;
  const glm::ivec3 cells = voxels_.grid().cells;
  const Axis& a = axes_[axis];
  const auto column_at = [&](int at_b, int at_c) {
    Column column{at_b, at_c, 0, 0.0f, true, true};
    column.depth =
        point[axis] + (a.slope_b * (point[b] - float(at_b) - 0.5f) + a.slope_c * (point[c] - float(at_c) - 0.5f));
    column.face = face_of_depth(column.depth);
    return column;
  };
  const auto exists = [&](int at_b, int at_c) { return at_b >= 0 && at_b < cells[b] && at_c >= 0 && at_c < cells[c]; };
  int searching = ways_ == 2 ? 3 : 1;
  if (a.slope <= kFarthest && exists(own[b], own[c])) {  // all points of the cell are within half a slope
    const Column column = column_at(own[b], own[c]);
    for (int way = 0; way < ways_; ++way) {
      found[way].alike = side_at_once<axis>(column, way);
      if (found[way].alike >= 0) searching &= ~(1 << way);
    }
    if (searching != 0) searching &= anybody_around(axis, column);
    if (searching == 0) return;
  }
  const float low = float(own[axis]), high = low + 1.0f;  // where other points of the cell may be
  // The nearest columns, first its own.
  constexpr int kRing[9][2] = {{0, 0}, {-1, -1}, {0, -1}, {1, -1}, {-1, 0}, {1, 0}, {-1, 1}, {0, 1}, {1, 1}};
  for (const auto& ring : kRing) {
    if (!exists(own[b] + ring[0], own[c] + ring[1])) continue;
    Column column = column_at(own[b] + ring[0], own[c] + ring[1]);
    if (std::max(low - column.depth, column.depth - high) > kFarthest) continue;
    column.near = std::abs(column.depth - point[axis]) <= kFarthest;
    column.all_near = std::max(column.depth - low, high - column.depth) < kFarthest;
    if ((searching & 1) != 0 && look<axis>(column, 0, found[0])) searching &= ~1;
    if ((searching & 2) != 0 && look<axis>(column, 1, found[1])) searching &= ~2;
    if (searching == 0) return;
  }
}

SidesOfPoint SideSearch::weighted(const Found (&by_axis)[3][2], int way, bool& place_matters) const {
  bool any_alike = false, alike_varies = false, facing_varies = false;
  for (const auto& of_axis : by_axis) {
    const Found& f = of_axis[way];
    any_alike |= f.alike >= 0;
    alike_varies |= f.alike_varies;
    facing_varies |= f.facing_varies;
  }
  place_matters |= alike_varies || (!any_alike && facing_varies);
  SidesOfPoint out;
  for (int axis = 0; axis < 3; ++axis) {
    out.sides[axis] = any_alike ? by_axis[axis][way].alike : by_axis[axis][way].facing;
    if (out.sides[axis] >= 0) out.weights[axis] = std::abs(normals_[0][axis]);
  }
  out.weights /= std::max(out.weights.x + out.weights.y + out.weights.z, 1e-30f);
  return out;
}

SideSearch::Answer SideSearch::at(glm::vec3 point, glm::ivec3 cell) const {
  Found found[3][2];
  constexpr float kLeastShare = 1e-3f;
  const glm::vec3 share = glm::abs(normals_[0]);
  if (share.x >= kLeastShare) find<0>(point, cell, found[0]);
  if (share.y >= kLeastShare) find<1>(point, cell, found[1]);
  if (share.z >= kLeastShare) find<2>(point, cell, found[2]);
  Answer out;
  out.along = weighted(found, 0, out.place_matters);
  if (ways_ == 2) out.against = weighted(found, 1, out.place_matters);
  return out;
}

SidesOfPoint sides_of_point(const VoxelGrid& voxels, glm::vec3 world_position, glm::vec3 normal, int front) {
  const glm::vec3 point = shared::cell_from_world(voxels.grid(), world_position);
  return SideSearch(voxels, nullptr, normal, front, false).at(point, glm::ivec3(glm::floor(point))).along;
}

}  // namespace volgi
