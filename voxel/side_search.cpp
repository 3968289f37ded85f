#include "voxel/side_search.h"

#include <openvdb/tree/Tree.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>

#include <cmath>
#include "voxel/seeing_cells.h"
#include "voxel/side_search_around.h"
#include "voxel/side_search_internal.h"

namespace volgi {

namespace {

/// Numbers of bits of 0 ... 31.
constexpr std::array<std::uint8_t, 32> kBitCount = [] {
  std::array<std::uint8_t, 32> count{};
  for (size_t i = 1; i < count.size(); ++i) count[i] = std::uint8_t(count[i / 2] + i % 2);
  return count;
}();

constexpr float kOneLayer = 0.02f;  // cells: layers nearer than this count as one
constexpr float kFarthest = 3.0f;   // cells along the axis
constexpr float kMinShare = 1e-3f;  // of the normal along an axis that is asked

/// Whether a depth on the axis is farther than that from all points of a cell.
bool farther(float low, float depth) { return !(std::max(low - depth, depth - (low + 1.0f)) <= kFarthest); }

/// Whether a surface whose plane passes the column's centre at `depth` lies behind the one that the side shows, by more
/// than the two can part within half the diagonal of a face when they are one bent surface.
bool behind_side(const shared::Side& side, const glm::vec3& normal, int axis, float depth) {
  const float behind = (side.depth - depth) * side.normal[axis];
  if (!(behind > kOneLayer)) return false;
  const float cosine = glm::clamp(glm::dot(side.normal, normal), 0.1f, 1.0f);
  const float bend = std::sqrt(1.0f - cosine * cosine) / cosine;
  return behind > kOneLayer + 0.75f * bend;
}

}  // namespace

SideColumns::SideColumns(const VoxelGrid& voxels) {
  const BlockBox& held = voxels.held();
  const glm::ivec3 first = kLeafCells * held.first;
  const glm::ivec3 cells = glm::max(glm::min(kLeafCells * held.last, voxels.grid().cells) - first, 0);
  for (int axis = 0; axis < 3; ++axis) {
    const int b = shared::axis_b(axis), c = shared::axis_c(axis);
    const int stride = held.size()[axis] + 2 * kPad, columns_b = cells[b] + 2 * kPad;
    layout_[size_t(axis)] = {stride, columns_b, cells[c] + 2 * kPad,
                             held.first[axis] + stride * (first[b] + columns_b * first[c])};
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
      std::uint8_t& to = columns_[size_t(face) + 6 * size_t(front)][size_t(
          byte(face, cell[shared::axis_b(axis)], cell[shared::axis_c(axis)]) + (origin[axis] >> kLeafShift))];
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

SideSearch::SideSearch(const VoxelGrid& voxels, const SideColumns* columns, glm::vec3 normal, int front, bool both,
                       bool at_rim)
    : voxels_(voxels),
      columns_(columns),
      normals_{normal, -normal},
      fronts_{front, 1 - front},
      ways_(both ? 2 : 1),
      at_rim_(at_rim) {
  for (int axis = 0; axis < 3; ++axis) {
    if (!(std::abs(normal[axis]) >= kMinShare)) continue;
    prepare(axis, columns);
    weights_[axis] = std::abs(normal[axis]);
  }
  weights_ /= std::max(weights_.x + weights_.y + weights_.z, 1e-30f);
}

void SideSearch::prepare(int axis, const SideColumns* columns) {
  searched_axes_ |= 1 << axis;
  const glm::vec3 normal = normals_[0];
  Axis& a = axes_[axis];
  a.slope_b = normal[shared::axis_b(axis)] / normal[axis];
  a.slope_c = normal[shared::axis_c(axis)] / normal[axis];
  a.slope = std::abs(a.slope_b) + std::abs(a.slope_c);
  a.to_face = steps_to_face(shared::falls_below_centre(normal, axis));
  // Where the normal runs up the axis, the cells above the surface see it; they have it at their lower face.
  const bool up = normal[axis] > 0.0f;
  a.faces[0] = shared::face_of(axis, !up);
  a.faces[1] = shared::face_of(axis, up);
  a.below[0] = up ? 0 : 1;
  a.below[1] = up ? 1 : 0;
  for (int way = 0; columns != nullptr && way < 2; ++way) {
    a.columns[way] = columns->of_face(a.faces[way], fronts_[way]);
  }
}

/// Bits of the cells beside and below, at and above the face of the plane that have a side asked for (with columns), or
/// any side on that face (without).
template <int axis>
inline std::uint32_t SideSearch::cells_with_side(const Column& column, int way) const {
  const Axis& a = axes_[axis];
  const int first = column.face - a.below[way] - 1;
  if (columns_ != nullptr) {
    const SideColumns::Columns& of_way = a.columns[way];
    return of_way.column(of_way.offset(column.b, column.c), first) & 7u;
  }
  glm::ivec3 cell;
  cell[(axis + 1) % 3] = column.b;
  cell[(axis + 2) % 3] = column.c;
  std::uint32_t bits = 0;
  for (int k = 0; k < 3; ++k) {
    cell[axis] = first + k;
    if (cell[axis] < 0 || cell[axis] >= voxels_.grid().cells[axis]) continue;
    bits |= std::uint32_t(shared::has_side(voxels_.cell_sides(cell), a.faces[way])) << k;
  }
  return bits;
}

template <int axis>
inline glm::ivec3 SideSearch::cell_at(const Column& column, int cell) {
  glm::ivec3 at;
  at[(axis + 1) % 3] = column.b;
  at[(axis + 2) % 3] = column.c;
  at[axis] = cell;
  return at;
}

template <int axis>
inline SideSearch::Place SideSearch::place_of(const glm::vec3& point, const glm::ivec3& own) const {
  return {point[axis], fronts_[0] < 0 ? std::floor(point[axis]) : float(own[axis]), point, own};
}

/// Whether a cell and the one that sees the point are on one side of what is around.
inline bool SideSearch::is_open_to(const Place& place, const glm::ivec3& cell, const glm::vec3& normal) const {
  return !hidden_from_cell(voxels_, cell, place.point, normal) && (at_rim_ || open_way(voxels_, place.seeing, cell));
}

/// Index of the side of a column's cell, which must have it.
template <int axis>
inline std::uint32_t SideSearch::side_of(const Column& column, int cell, int way) const {
  const glm::uvec2 own = voxels_.cell_sides(cell_at<axis>(column, cell));
  return own.x + kBitCount[own.y & ((1u << axes_[axis].faces[way]) - 1u)];
}

/// Looks at the sides of a column, `three` as cells_with_side has it: at the face of the plane first, then at those
/// beside it. True when one is alike.
template <int axis>
inline bool SideSearch::look(const Column& column, std::uint32_t three, const Place& place, int way,
                             Found& found) const {
  const int middle = column.face - axes_[axis].below[way];
  if (three == 0) return false;
  const int front = fronts_[way];
  const glm::vec3& normal = normals_[way];
  // To the point, and to all points of the cell.
  const bool near = std::abs(column.depth - place.at) <= kFarthest;
  const bool all_near = std::max(column.depth - place.low, place.low + 1.0f - column.depth) < kFarthest;
  for (int step : {0, 1, -1}) {
    if ((three >> (step + 1) & 1u) == 0) continue;
    const std::uint32_t index = side_of<axis>(column, middle + step, way);
    const shared::Side& side = voxels_.sides()[index];
    if (front < 0 && !is_open_to(place, cell_at<axis>(column, middle + step), normal)) continue;
    if (front >= 0 && (side.front != front || behind_side(side, normal, axis, column.depth))) continue;
    const float cosine = glm::dot(side.normal, normal);
    if (!(cosine >= 0.0f)) continue;
    if (found.facing < 0 && !at_rim_) {
      found.facing_varies |= !all_near;
      if (near) found.facing = int(index);
    }
    if (!(cosine >= SIMILAR_NORMAL_COSINE)) continue;
    found.alike_varies |= !all_near;
    if (!near) continue;
    found.alike = int(index);
    return true;
  }
  return false;
}

/// Whether one of the nine columns around has a side that the plane might ask for.
template <int axis>
inline bool SideSearch::any_side_around(const Column& own, int way) const {
  if (columns_ == nullptr) return true;
  const Axis& a = axes_[axis];
  const float slope = a.slope > 0.0f ? a.slope + 1e-3f : 0.0f;  // rounding
  const int first = face_of_depth_quick(own.depth - slope, a.to_face) - 1,
            last = face_of_depth_quick(own.depth + slope, a.to_face) + 1;
  const SideColumns::Columns& columns = a.columns[way];
  return (columns.around(columns.offset(own.b, own.c), first - a.below[way]) & ((1u << (last - first + 1)) - 1)) != 0;
}

/// The quick way to what most searches end with: the plane's own face has the side asked for.
template <int axis>
inline int SideSearch::side_at_once(const Column& column, const Place& place, int way) const {
  if ((cells_with_side<axis>(column, way) & 2u) == 0) return -1;
  const std::uint32_t index = side_of<axis>(column, column.face - axes_[axis].below[way], way);
  const shared::Side& side = voxels_.sides()[index];
  const bool good = (side.front == fronts_[way] || fronts_[way] < 0) &&
                    (fronts_[way] < 0 || (side.depth - column.depth) * side.normal[axis] <= kOneLayer) &&
                    glm::dot(side.normal, normals_[way]) >= SIMILAR_NORMAL_COSINE &&
                    (fronts_[way] >= 0 ||
                     is_open_to(place, cell_at<axis>(column, column.face - axes_[axis].below[way]), normals_[way]));
  return good ? int(index) : -1;
}

template <int axis>
inline SideSearch::Column SideSearch::column_at(const glm::vec3& point, int b, int c) const {
  const Axis& a = axes_[axis];
  const float depth = point[axis] + (a.slope_b * (point[(axis + 1) % 3] - float(b) - 0.5f) +
                                     a.slope_c * (point[(axis + 2) % 3] - float(c) - 0.5f));
  return {b, c, face_of_depth_quick(depth, a.to_face), depth};
}

template <int axis>
inline void SideSearch::find(const glm::vec3& point, const glm::ivec3& own, Found* found) const {
  constexpr int b = (axis + 1) % 3, c = (axis + 2) % 3;
  const glm::ivec3& cells = voxels_.grid().cells;
  int searching = ways_ == 2 ? 3 : 1;
  const bool exists = own[b] >= 0 && own[b] < cells[b] && own[c] >= 0 && own[c] < cells[c];
  if (axes_[axis].slope <= kFarthest && exists) {  // all points of the cell are within half a slope
    const Column column = column_at<axis>(point, own[b], own[c]);
    const Place place = place_of<axis>(point, own);
    for (int way = 0; way < ways_; ++way) {
      found[way].alike = side_at_once<axis>(column, place, way);
      if (found[way].alike >= 0 || !any_side_around<axis>(column, way)) searching &= ~(1 << way);
    }
  }
  if (searching == 0) return;
  if (columns_ != nullptr) {
    find_around_quick<axis>(point, own, searching, found);
  } else {
    find_around<axis>(point, own, searching, found);
  }
}

/// The nine nearest columns, first the own one, then row by row.
template <int axis>
void SideSearch::find_around(const glm::vec3& point, const glm::ivec3& own, int searching, Found* found) const {
  constexpr int b = (axis + 1) % 3, c = (axis + 2) % 3;
  constexpr int kOrder[9] = {4, 0, 1, 2, 3, 5, 6, 7, 8};
  const glm::ivec3& cells = voxels_.grid().cells;
  const Place place = place_of<axis>(point, own);
  for (int k : kOrder) {
    const int at_b = own[b] + k % 3 - 1, at_c = own[c] + k / 3 - 1;
    if (at_b < 0 || at_b >= cells[b] || at_c < 0 || at_c >= cells[c]) continue;
    const Column column = column_at<axis>(point, at_b, at_c);
    if (farther(place.low, column.depth)) continue;
    for (int way = 0; way < ways_; ++way) {
      if ((searching >> way & 1) == 0) continue;
      if (look<axis>(column, cells_with_side<axis>(column, way), place, way, found[way])) searching &= ~(1 << way);
    }
    if (searching == 0) return;
  }
}

/// The same by columns of bits.
template <int axis>
void SideSearch::find_around_quick(const glm::vec3& point, const glm::ivec3& own, int searching, Found* found) const {
  constexpr int b = (axis + 1) % 3, c = (axis + 2) % 3;
  static const ColumnsAround around = columns_around();
  const Axis& a = axes_[axis];
  const Place place = place_of<axis>(point, own);
  const int offset = a.columns[0].offset(own[b], own[c]);
  const AroundQuery query{point[axis],
                          point[b],
                          point[c],
                          place.low,
                          float(own[b]),
                          float(own[c]),
                          a.slope_b,
                          a.slope_c,
                          kFarthest,
                          a.to_face,
                          a.columns[0].stride_b,
                          a.columns[0].stride_c,
                          {a.columns[0].column_bytes + offset, a.columns[1].column_bytes + offset},
                          {a.below[0] + 1, a.below[1] + 1}};
  AroundColumns columns;
  const std::uint32_t with_sides = around(query, columns);
  const Column middle = column_at<axis>(point, own[b], own[c]);
  const bool middle_counts = !farther(place.low, middle.depth);
  for (int way = 0; way < ways_; ++way) {
    if ((searching >> way & 1) == 0) continue;
    if (middle_counts && look<axis>(middle, cells_with_side<axis>(middle, way), place, way, found[way])) continue;
    for (std::uint32_t rest = with_sides >> (8 * way) & 255u; rest != 0; rest &= rest - 1) {
      const int k = std::countr_zero(rest), nine = k < 4 ? k : k + 1;
      const Column column{own[b] + nine % 3 - 1, own[c] + nine / 3 - 1, columns.face[k], columns.depth[k]};
      if (look<axis>(column, columns.three[way][k], place, way, found[way])) break;
    }
  }
}

inline SidesOfPoint SideSearch::weighted(const Found (&by_axis)[3][2], int way, bool& place_matters) const {
  int alike = 0;
  bool alike_varies = false, facing_varies = false;
  for (int axis = 0; axis < 3; ++axis) {
    const Found& f = by_axis[axis][way];
    alike |= int(f.alike >= 0) << axis;
    alike_varies |= f.alike_varies;
    facing_varies |= f.facing_varies;
  }
  place_matters |= alike_varies || (alike == 0 && facing_varies);
  SidesOfPoint out;
  for (int axis = 0; axis < 3; ++axis) {
    out.sides[axis] = alike != 0 ? by_axis[axis][way].alike : by_axis[axis][way].facing;
  }
  if (alike == searched_axes_) {
    out.weights = weights_;
    return out;
  }
  for (int axis = 0; axis < 3; ++axis) {
    if (out.sides[axis] >= 0) out.weights[axis] = std::abs(normals_[0][axis]);
  }
  out.weights /= std::max(out.weights.x + out.weights.y + out.weights.z, 1e-30f);
  return out;
}

/// Where the plane lies across one axis, as most do.
template <int axis>
inline SideSearch::Answer SideSearch::at_one_axis(const glm::vec3& point, const glm::ivec3& cell) const {
  Found found[2];
  find<axis>(point, cell, found);
  Answer out;
  SidesOfPoint* const sides[2] = {&out.along, &out.against};
  for (int way = 0; way < ways_; ++way) {
    const Found& f = found[way];
    const int side = f.alike >= 0 ? f.alike : f.facing;
    out.place_matters |= f.alike_varies || (f.alike < 0 && f.facing_varies);
    sides[way]->sides[axis] = side;
    if (side >= 0) sides[way]->weights[axis] = 1.0f;
  }
  return out;
}

SideSearch::Answer SideSearch::at(const glm::vec3& point, const glm::ivec3& cell) const {
  if (searched_axes_ == 1) return at_one_axis<0>(point, cell);
  if (searched_axes_ == 2) return at_one_axis<1>(point, cell);
  if (searched_axes_ == 4) return at_one_axis<2>(point, cell);
  Found found[3][2];
  if ((searched_axes_ & 1) != 0) find<0>(point, cell, found[0]);
  if ((searched_axes_ & 2) != 0) find<1>(point, cell, found[1]);
  if ((searched_axes_ & 4) != 0) find<2>(point, cell, found[2]);
  Answer out;
  out.along = weighted(found, 0, out.place_matters);
  if (ways_ == 2) out.against = weighted(found, 1, out.place_matters);
  return out;
}

SidesOfPoint sides_of_point(const VoxelGrid& voxels, glm::vec3 world_position, glm::vec3 normal, int front) {
  const glm::vec3 point = shared::cell_from_world(voxels.grid(), world_position);
  const glm::ivec3 own(glm::floor(point)), seeing = front < 0 ? seeing_cell(voxels, point, normal) : own;
  const bool at_rim = front < 0 && !shared::cell_inside(voxels.grid(), seeing);
  return SideSearch(voxels, nullptr, normal, front, false, at_rim).at(point, at_rim ? own : seeing).along;
}

}  // namespace volgi
