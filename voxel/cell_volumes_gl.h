#pragma once
#include <array>
#include <glm/glm.hpp>
#include <vector>

#include "core/gl/objects.h"
#include "core/gl/pass_timer.h"
#include "core/gl/program.h"
#include "core/gl/scene_buffers.h"
#include "voxel/grid.h"

namespace volgi {

/// What cells hold of the surfaces in them, on the GPU; twin of CellVolumes (cell_volumes_cpu), timer
/// "voxel/cell_volumes". Textures have one texel a cell, cell (i,j,k) at texel (i,j,k).
///
/// Counted from the same pieces as the areas of sides: each fine line that meets a triangle, seen along the axis
/// nearest to its normal, stands for the piece of it around. Fixed point: results do not depend on order. Only for
/// those who ask (the papers' schemes, export, looking at): one raster pass. Memory: 32 bytes a cell, and 48 while it
/// runs, which are kept for the next frame.
class CellVolumesGl {
 public:
  explicit CellVolumesGl(const Grid& grid);

  void run(const gl::SceneBuffers& scene, gl::PassTimer& timer);

  /// RGBA16F. xyz: area-weighted mean of the fronts' normals, unit; zero where they cancel or nothing is. w: occupancy,
  /// the largest share of light that a surface in the cell stops.
  const gl::Texture& normal_occupancy() const { return normal_occupancy_; }
  /// RGBA16F. Area-weighted mean; w is 1 where the cell has any surface.
  const gl::Texture& albedo() const { return albedo_; }
  /// RGBA32F. Largest radiosity pi * L_e in the cell, per channel [W m^-2]; w is 0.
  const gl::Texture& emission() const { return emission_; }
  size_t bytes() const { return bytes_for(grid_); }
  static size_t bytes_for(const Grid& grid);

  /// By cell index, for tests, export and the crosscheck. Waits for the GPU.
  struct Cells {
    std::vector<float> occupancy;
    std::vector<glm::vec3> albedo, normal, emission;
  };
  Cells download() const;

 private:
  Grid grid_;
  gl::Program sum_, resolve_;
  gl::Buffer grid_block_;
  std::array<gl::Buffer, 6> sums_;  // shaders/voxel/cell_sums.glsl
  gl::Texture normal_occupancy_, albedo_, emission_;
  gl::Framebuffer columns_;
};

}  // namespace volgi
