#include "propagation/radiance_volume_gl.h"

#include <cstring>

namespace volgi {

RadianceVolumeGl::RadianceVolumeGl(const Grid& grid_of_cells, int coefficient_count)
    : grid(grid_of_cells),
      coefficients(coefficient_count),
      sh(gl::Texture::make_3d(GL_RGBA32F, {grid.cells.x, grid.cells.y, coefficient_count * grid.cells.z})) {
  sh.clear({0.0f, 0.0f, 0.0f, 0.0f});
}

std::vector<std::vector<glm::vec4>> RadianceVolumeGl::download() const {
  glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);
  const std::vector<float> texels = sh.download(4);
  const size_t cells = cell_count(grid);
  std::vector<std::vector<glm::vec4>> by_coefficient;
  for (size_t c = 0; c < size_t(coefficients); ++c) {
    by_coefficient.emplace_back(cells);
    std::memcpy(by_coefficient.back().data(), texels.data() + 4 * c * cells, cells * sizeof(glm::vec4));
  }
  return by_coefficient;
}

}  // namespace volgi
