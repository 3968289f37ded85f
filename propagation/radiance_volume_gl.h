#pragma once
#include <vector>

#include "core/gl/objects.h"
#include "voxel/grid.h"

namespace volgi {

/// Radiance in free space on the GPU, as spherical harmonics per cell [W m^-2 sr^-1]; twin of RadianceVolume, which
/// says what the coefficients are. Memory: 64 or 144 bytes a cell.
struct RadianceVolumeGl {
  RadianceVolumeGl() = default;
  /// Zero everywhere. @param coefficient_count  4 or 9.
  RadianceVolumeGl(const Grid& grid_of_cells, int coefficient_count);

  Grid grid{};
  int coefficients = 0;
  gl::Texture sh;  // RGBA32F, rgb: coefficient c of cell (i,j,k) is at (i, j, k + c cells.z)

  /// By coefficient, then by cell_index. Waits for the GPU.
  std::vector<std::vector<glm::vec4>> download() const;
  size_t bytes() const { return bytes_for(grid, coefficients); }
  static size_t bytes_for(const Grid& grid, int coefficients) { return 16 * size_t(coefficients) * cell_count(grid); }
};

}  // namespace volgi
