// Grids of more cells than 65535 groups take (fault: from 162 cells a side on, the last cells were never prepared).
#include "propagation/transport_ordinates_gl.h"
#include "tests/propagation/synthetic_voxels.h"
#include "tests/support/gl_test.h"

namespace volgi::test {
namespace {

using LargeGrid = GlTest;

/// The last cell is closed on all sides: what its walls send, they receive.
TEST_F(LargeGrid, LastCellReceivesWhatItSends) {
  constexpr glm::ivec3 cells(3, 1300, 1100);
  static_assert(cells.x * cells.y * cells.z > 65535 * 64);
  const VoxelGrid voxels = make_voxels(cells, 1.0f, [&](int axis, glm::ivec3 c) {
    glm::ivec3 other = c;
    other[axis] -= 1;
    return c == cells - 1 || other == cells - 1 ? 1.0f : 0.0f;
  });
  ASSERT_EQ(voxels.sides().size(), 9u) << "six inside, three outside";
  const VoxelGridGl gpu = upload(voxels);
  OrdinatesTransportGl transport(voxels.grid(), 8, Ordinates::step);
  Powers sent(gpu.side_capacity, glm::vec4(0.0f));
  for (size_t i = 0; i < voxels.sides().size(); ++i) {
    if (shared::cell_coord(voxels.grid(), voxels.sides()[i].cell) == cells - 1)
      sent[i] = glm::vec4(1.0f, 2.0f, 3.0f, 0.0f);
  }
  const gl::Buffer from(sent), to(sent.size() * sizeof(glm::vec4));
  to.clear();
  BounceReport report;
  transport.carry(gpu, from, to, BounceRules{}, report);
  const glm::dvec3 received = sum(to.download<glm::vec4>(sent.size()));
  for (int band = 0; band < 3; ++band) EXPECT_NEAR(received[band] / sum(sent)[band], 1.0, 1e-5);
}

}  // namespace
}  // namespace volgi::test
