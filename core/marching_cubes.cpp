#include "core/marching_cubes.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cstdint>
#include <utility>

namespace volgi {

namespace {

// Corner c of a cell lies at (c & 1, c >> 1 & 1, c >> 2). Edge 4 a + i + 2 j runs along axis a where the next axes have
// coordinates i and j.

constexpr int kEdges = 12;
constexpr int kMaxTriangles = 5;  // of a cell
constexpr float kMinDistanceToNode = 0.01f;
constexpr int kRefinements = 4;  // of a vertex on its edge, by false position

constexpr int bit(int corner, int axis) { return corner >> axis & 1; }

constexpr int edge_between(int a, int b) {
  const int axis = std::countr_zero(unsigned(a ^ b));
  const int low = a & b;
  return 4 * axis + bit(low, (axis + 1) % 3) + 2 * bit(low, (axis + 2) % 3);
}

/// The faces 2 * axis + side that an edge lies on, as bits.
constexpr unsigned faces_of(int edge) {
  const int b = (edge / 4 + 1) % 3, c = (edge / 4 + 2) % 3;
  return 1u << (2 * b + (edge & 1)) | 1u << (2 * c + (edge >> 1 & 1));
}

/// Corners of a face, counter-clockwise seen from outside the cell.
constexpr std::array<int, 4> ring_of(int face) {
  const int axis = face / 2, b = 1 << (axis + 1) % 3, c = 1 << (axis + 2) % 3;
  if (face % 2 == 0) return {0, c, b | c, b};
  const int far = 1 << axis;
  return {far, far | b, far | b | c, far | c};
}

using Next = std::array<int, kEdges>;

/// Each run of inside corners around a face is cut off by one segment, from the edge where the ring enters it to the
/// edge where it leaves. The cell on the face's other side walks the ring the other way: its segments are the same,
/// turned round, whatever the other corners are, so that no pair of cells leaves a hole. Every crossed edge is entered
/// on one of its faces and left on the other: segments join into loops, counter-clockwise seen from outside the
/// surface.
constexpr Next segments_of(unsigned inside) {
  Next next{};
  next.fill(-1);
  for (int face = 0; face < 6; ++face) {
    const std::array<int, 4> ring = ring_of(face);
    const auto corner = [&](size_t i) { return ring[i % 4]; };
    const auto is_in = [&](size_t i) { return (inside >> corner(i) & 1u) != 0; };
    for (size_t i = 0; i < 4; ++i) {
      if (is_in(i) || !is_in(i + 1)) continue;
      size_t last = i + 1;
      while (is_in(last + 1)) ++last;
      next[size_t(edge_between(corner(i), corner(i + 1)))] = edge_between(corner(last), corner(last + 1));
    }
  }
  return next;
}

struct Loop {
  std::array<int, kEdges> edges{};
  int count = 0;
  int at(int i) const { return edges[size_t(i % count)]; }
};

/// Whether the fan from one corner of a loop keeps off the cell's faces, where a neighbour's fan could use the same
/// edge again.
bool fan_stays_inside(const Loop& loop, int apex) {
  for (int k = 2; k + 1 < loop.count; ++k) {
    if ((faces_of(loop.at(apex)) & faces_of(loop.at(apex + k))) != 0) return false;
  }
  return true;
}

/// Triangles of one of the 256 cells, as edges.
struct CellTriangles {
  std::array<std::array<std::uint8_t, 3>, kMaxTriangles> edges{};
  int count = 0;

  void add_loop(const Loop& loop) {
    int apex = 0;
    while (!fan_stays_inside(loop, apex)) ++apex;  // each of the 256 has one
    assert(apex < loop.count);
    for (int k = 1; k + 1 < loop.count; ++k) {
      edges[size_t(count++)] = {std::uint8_t(loop.at(apex)), std::uint8_t(loop.at(apex + k)),
                                std::uint8_t(loop.at(apex + k + 1))};
    }
  }
};

CellTriangles triangles_of(unsigned inside) {
  Next next = segments_of(inside);
  CellTriangles out;
  for (int first = 0; first < kEdges; ++first) {
    Loop loop;
    for (int edge = first; next[size_t(edge)] >= 0;) {
      loop.edges[size_t(loop.count++)] = edge;
      edge = std::exchange(next[size_t(edge)], -1);
    }
    if (loop.count > 0) out.add_loop(loop);
  }
  return out;
}

const std::array<CellTriangles, 256>& cell_table() {
  static const std::array<CellTriangles, 256> table = [] {
    std::array<CellTriangles, 256> made;
    for (unsigned inside = 0; inside < 256; ++inside) made[inside] = triangles_of(inside);
    return made;
  }();
  return table;
}

class Mesher {
 public:
  Mesher(const FieldSamples& samples, const std::function<float(glm::vec3)>& value_at)
      : samples_(samples), value_at_(value_at), vertex_of_edge_(3 * samples.values.size(), kNone) {}

  Isosurface run() {
    const glm::ivec3 cells = samples_.nodes - 1;
    for (int z = 0; z < cells.z; ++z)
      for (int y = 0; y < cells.y; ++y)
        for (int x = 0; x < cells.x; ++x) add_cell({x, y, z});
    return std::move(surface_);
  }

 private:
  static constexpr std::uint32_t kNone = 0xffffffffu;

  void add_cell(glm::ivec3 cell) {
    unsigned inside = 0;
    for (int c = 0; c < 8; ++c) {
      const glm::ivec3 node = cell + glm::ivec3(bit(c, 0), bit(c, 1), bit(c, 2));
      inside |= unsigned(samples_.values[samples_.index(node)] > 0.0f) << c;
    }
    const CellTriangles& triangles = cell_table()[inside];
    for (int i = 0; i < triangles.count; ++i) {
      const auto& edges = triangles.edges[size_t(i)];
      const std::uint32_t a = vertex(cell, edges[0]), b = vertex(cell, edges[1]), c = vertex(cell, edges[2]);
      surface_.triangles.emplace_back(a, b, c);
    }
  }

  std::uint32_t vertex(glm::ivec3 cell, int edge) {
    const int axis = edge / 4;
    glm::ivec3 node = cell;
    node[(axis + 1) % 3] += edge & 1;
    node[(axis + 2) % 3] += edge >> 1 & 1;
    std::uint32_t& known = vertex_of_edge_[3 * samples_.index(node) + size_t(axis)];
    if (known == kNone) {
      known = std::uint32_t(surface_.positions.size());
      surface_.positions.push_back(crossing(node, axis));
    }
    return known;
  }

  /// Where the field is zero between a node and the next one, by false position (the Illinois rule).
  glm::vec3 crossing(glm::ivec3 node, int axis) const {
    glm::ivec3 next = node;
    next[axis] += 1;
    const glm::vec3 start = samples_.position(node);
    float low = 0.0f, high = 1.0f;  // of the edge
    float at_low = samples_.values[samples_.index(node)], at_high = samples_.values[samples_.index(next)];
    float part = at_low / (at_low - at_high);
    int moved = 0;  // which end the last step moved
    for (int i = 0; i < kRefinements; ++i) {
      glm::vec3 p = start;
      p[axis] += part * samples_.spacing_m;
      const float value = value_at_(p);
      if (value == 0.0f) break;
      const int end = (value > 0.0f) == (at_low > 0.0f) ? -1 : 1;
      (end < 0 ? low : high) = part;
      (end < 0 ? at_low : at_high) = value;
      if (end == moved) (end < 0 ? at_high : at_low) *= 0.5f;
      moved = end;
      part = low + (high - low) * at_low / (at_low - at_high);
    }
    glm::vec3 p = start;
    p[axis] += std::clamp(part, kMinDistanceToNode, 1.0f - kMinDistanceToNode) * samples_.spacing_m;
    return p;
  }

  const FieldSamples& samples_;
  const std::function<float(glm::vec3)>& value_at_;
  std::vector<std::uint32_t> vertex_of_edge_;
  Isosurface surface_;
};

}  // namespace

Isosurface marching_cubes(const FieldSamples& samples, const std::function<float(glm::vec3)>& value_at) {
  assert(samples.values.size() == size_t(samples.nodes.x) * size_t(samples.nodes.y) * size_t(samples.nodes.z));
  return Mesher(samples, value_at).run();
}

}  // namespace volgi
