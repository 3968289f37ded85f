#include "propagation/transport_ordinates_gl.h"

#include <fmt/format.h>

#include <algorithm>

namespace volgi {

OrdinatesTransportGl::OrdinatesTransportGl(const Grid& grid, int directions)
    : set_(ordinate_set(directions)),
      sweep_(
          gl::Program::compute("propagation/sweep.comp.glsl", {fmt::format("PER_OCTANT {}", set_.directions.size())})),
      collect_(gl::Program::compute("propagation/collect_octants.comp.glsl")),
      grid_(grid) {
  for (gl::Texture& t : planes_) {
    t = gl::Texture::make_2d_array(GL_RGBA32F, grid.cells.x, grid.cells.y, 8 * int(set_.directions.size()));
  }
  for (size_t d = 0; d < set_.directions.size(); ++d) {
    const glm::vec3 direction = set_.directions[d];
    sweep_.set(fmt::format("emitted_share[{}]", d).c_str(), direction * (set_.weights[d] / set_.t));
    sweep_.set(fmt::format("downwind_share[{}]", d).c_str(), direction / (direction.x + direction.y + direction.z));
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
  sweep_.use();
  const glm::ivec3 n = grid_.cells;
  for (int plane = 0; plane <= n.x + n.y + n.z - 3; ++plane) {
    // Columns (i,j) that have a cell i+j+k = plane lie in this box.
    const glm::ivec2 first(std::max(0, plane - (n.y - 1) - (n.z - 1)), std::max(0, plane - (n.x - 1) - (n.z - 1)));
    const glm::ivec2 last(std::min(n.x - 1, plane), std::min(n.y - 1, plane));
    sweep_.set("plane", plane);
    sweep_.set("first_column", first);
    planes_[(plane + 1) & 1].bind(0);
    planes_[plane & 1].bind_image(0, GL_WRITE_ONLY);
    gl::dispatch({last.x - first.x + 1, last.y - first.y + 1, 8}, {8, 8, 1});
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
  }
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  received.bind_storage(6);
  collect_.use();
  gl::dispatch({int(capacity_), 1, 1}, {64, 1, 1});
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  report.passes += 1;
}

size_t OrdinatesTransportGl::bytes() const {
  return arrived_.bytes() + 2 * 16 * 8 * set_.directions.size() * size_t(grid_.cells.x) * size_t(grid_.cells.y);
}

}  // namespace volgi
