// Voxels turned by 90 degrees about an axis give the same numbers (docs/hard-cases.md, "rotate").
#include <gtest/gtest.h>

#include <functional>

#include "propagation/transport_conservative_gl.h"
#include "propagation/transport_ordinates_gl.h"
#include "tests/propagation/transport_scene.h"

namespace volgi::test {
namespace {

/// A quarter turn about `axis`: x -> y -> -x of the two other axes, in cyclic order.
struct QuarterTurn {
  int axis;
  glm::ivec3 cell(glm::ivec3 c, glm::ivec3 cells) const {
    const int b = shared::axis_b(axis), a = shared::axis_c(axis);
    glm::ivec3 t = c;
    t[a] = c[b];
    t[b] = cells[a] - 1 - c[a];
    return t;
  }
  glm::ivec3 size(glm::ivec3 cells) const {
    const int b = shared::axis_b(axis), a = shared::axis_c(axis);
    std::swap(cells[a], cells[b]);
    return cells;
  }
  int face(int f) const {
    const int b = shared::axis_b(axis), a = shared::axis_c(axis);
    if (shared::face_axis(f) == axis) return f;
    if (shared::face_axis(f) == b) return shared::face_of(a, (f & 1) != 0);
    return shared::face_of(b, (f & 1) == 0);
  }
};

struct Turned {
  Voxels voxels;
  std::vector<size_t> from;  // of each side
};

Turned turn(const Voxels& v, QuarterTurn q) {
  Turned t;
  t.voxels.grid = v.grid;
  t.voxels.grid.cells = q.size(v.grid.cells);
  std::vector<int> source(v.cells.size());
  for (int i = 0; i < int(v.cells.size()); ++i) {
    source[size_t(shared::cell_index(t.voxels.grid, q.cell(shared::cell_coord(v.grid, i), v.grid.cells)))] = i;
  }
  for (int i = 0; i < int(source.size()); ++i) {
    const glm::uvec2 old = v.cells[size_t(source[size_t(i)])];
    glm::uvec2 cell(std::uint32_t(t.from.size()), 0u);
    int from_face[6];
    for (int face = 0; face < 6; ++face) from_face[q.face(face)] = face;
    for (int face = 0; face < 6; ++face) {
      const int f = from_face[face];
      if (!shared::has_side(old, f)) continue;
      cell.y |= 1u << face;
      if (shared::is_opaque(old, f)) cell.y |= 256u << face;
      t.from.push_back(shared::side_index(old, f));
      Side side = v.sides[t.from.back()];
      side.cell = i;
      side.face = face;
      t.voxels.sides.push_back(side);
    }
    t.voxels.cells.push_back(cell);
  }
  return t;
}

class TurnedGl : public GlTest {
 protected:
  static void expect_same(const Voxels& v, const std::function<std::unique_ptr<TransportGl>(const Grid&)>& make) {
    const Powers sent = random_powers(v.sides.size(), 51);
    auto plain = make(v.grid);
    const Powers expected = carry(*plain, upload(v), sent);
    float largest = 0.0f;
    for (const glm::vec4& p : expected) largest = std::max(largest, p.x);
    for (int axis = 0; axis < 3; ++axis) {
      const Turned t = turn(v, QuarterTurn{axis});
      ASSERT_EQ(t.from.size(), v.sides.size());
      Powers turned_sent;
      for (size_t from : t.from) turned_sent.push_back(sent[from]);
      auto transport = make(t.voxels.grid);
      const Powers received = carry(*transport, upload(t.voxels), turned_sent);
      float worst = 0.0f;
      for (size_t i = 0; i < received.size(); ++i) {
        for (int band = 0; band < 3; ++band)
          worst = std::max(worst, std::abs(received[i][band] - expected[t.from[i]][band]));
      }
      EXPECT_LT(worst, 1e-5f * largest) << "about axis " << axis;
    }
  }
  /// Not a cube, and furnished beyond its middle.
  Voxels voxels() {
    Grid grid = unit_grid(12);
    grid.cells = {12, 9, 7};
    return voxelize(context(), furnished_box(), grid);
  }
};

TEST_F(TurnedGl, Step) {
  for (int directions : {8, 24, 48}) {
    expect_same(voxels(), [&](const Grid& grid) { return std::make_unique<OrdinatesTransportGl>(grid, directions); });
  }
}

TEST_F(TurnedGl, Characteristic) {
  for (int directions : {48, 80, 128}) {
    expect_same(voxels(), [&](const Grid& grid) {
      return std::make_unique<OrdinatesTransportGl>(grid, directions, Ordinates::characteristic);
    });
  }
}

TEST_F(TurnedGl, Conservative) {
  for (int order : {1, 2}) {
    expect_same(voxels(), [&](const Grid& grid) { return std::make_unique<ConservativeTransportGl>(grid, order); });
  }
}

}  // namespace
}  // namespace volgi::test
