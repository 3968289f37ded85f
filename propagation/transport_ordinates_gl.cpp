#include "propagation/transport_ordinates_gl.h"

#include <string>

namespace volgi {

OrdinatesTransportGl::OrdinatesTransportGl(const Grid& grid, int directions)
    : set_(ordinate_set(directions)),
      sweep_(gl::Program::compute("propagation/sweep.comp.glsl", {"PER_OCTANT " + std::to_string(set_.directions.size())})),
      collect_(gl::Program::compute("propagation/collect_octants.comp.glsl")),
      planes_(sizeof(float) * 8 * 2 * 3 * set_.directions.size() * size_t(grid.cells.x) * size_t(grid.cells.y)) {
  for (size_t d = 0; d < set_.directions.size(); ++d) {
    std::string name = "directions[" + std::to_string(d) + "]";
    sweep_.set(name.c_str(), glm::vec4(set_.directions[d], set_.weights[d] / set_.t));
  }
}

void OrdinatesTransportGl::carry(const VoxelGridGl& voxels, const gl::Buffer& sent, const gl::Buffer& received,
                                 const BounceRules& /*rules*/, BounceReport& report) {
  if (capacity_ != voxels.side_capacity) {
    capacity_ = voxels.side_capacity;
    arrived_ = gl::Buffer(4 * sizeof(glm::vec4) * size_t(capacity_));
  }
  voxels.bind();
  sent.bind_storage(7);
  arrived_.bind_storage(10);
  planes_.bind_storage(11);
  sweep_.use();
  const glm::ivec3 cells = voxels.grid.cells;
  for (int plane = 0; plane <= cells.x + cells.y + cells.z - 3; ++plane) {
    sweep_.set("plane", plane);
    gl::dispatch({cells.x, cells.y, 8}, {16, 4, 1});
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  }
  received.bind_storage(6);
  collect_.use();
  gl::dispatch({int(capacity_), 1, 1}, {64, 1, 1});
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  report.passes += 1;
}

}  // namespace volgi
