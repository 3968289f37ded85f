#include "voxel/cell_volumes_gl.h"

#include <algorithm>

#include "core/gl/raster_state.h"
#include "shaders/shared/group_sizes.shared.h"
#include "shaders/voxel/slots.shared.h"

namespace volgi {

CellVolumesGl::CellVolumesGl(const Grid& grid)
    : grid_(grid),
      // With alpha, whatever the scene: this pass is not for every frame.
      sum_(gl::Program::raster("voxel/cell_volumes", std::vector<std::string>{"ALPHA 1"})),
      resolve_(gl::Program::compute("voxel/cell_volumes.comp.glsl")),
      grid_block_(sizeof(Grid), &grid),
      normal_occupancy_(gl::Texture::make_3d(GL_RGBA16F, grid.cells)),
      albedo_(gl::Texture::make_3d(GL_RGBA16F, grid.cells)),
      emission_(gl::Texture::make_3d(GL_RGBA32F, grid.cells)),
      columns_(gl::Framebuffer::without_attachments(glm::ivec2(std::max({grid.cells.x, grid.cells.y, grid.cells.z})))) {
  for (gl::Buffer& sums : sums_) sums = gl::Buffer(sizeof(glm::uvec2) * cell_count(grid));
}

void CellVolumesGl::run(const gl::SceneBuffers& scene, gl::PassTimer& timer) {
  auto scope = timer.scope("voxel/cell_volumes");
  grid_block_.bind_uniform(GRID_BLOCK);
  for (GLuint i = 0; i < GLuint(sums_.size()); ++i) {
    sums_[i].clear();
    sums_[i].bind_storage(CELL_SUMS_SLOT + i);
  }
  gl::begin_fullscreen_pass();
  columns_.bind();
  scene.draw(sum_);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  normal_occupancy_.bind_image(NORMAL_OCCUPANCY_IMAGE, GL_WRITE_ONLY);
  albedo_.bind_image(CELL_ALBEDO_IMAGE, GL_WRITE_ONLY);
  emission_.bind_image(CELL_EMISSION_IMAGE, GL_WRITE_ONLY);
  resolve_.use();
  gl::dispatch(grid_.cells, {CELL_GROUP_X, CELL_GROUP_Y, CELL_GROUP_Z});
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT);
}

size_t CellVolumesGl::bytes_for(const Grid& grid) {
  constexpr size_t kSums = std::tuple_size_v<decltype(sums_)> * sizeof(glm::uvec2);
  return sizeof(Grid) + (8 + 8 + 16 + kSums) * cell_count(grid);
}

CellVolumesGl::Cells CellVolumesGl::download() const {
  Cells cells;
  const auto vectors = [](const std::vector<float>& texels) {
    std::vector<glm::vec3> v;
    v.reserve(texels.size() / 4);
    for (size_t i = 0; i < texels.size(); i += 4) v.emplace_back(texels[i], texels[i + 1], texels[i + 2]);
    return v;
  };
  const std::vector<float> texels = normal_occupancy_.download(4);
  cells.normal = vectors(texels);
  cells.occupancy.reserve(texels.size() / 4);
  for (size_t i = 3; i < texels.size(); i += 4) cells.occupancy.push_back(texels[i]);
  cells.albedo = vectors(albedo_.download(4));
  cells.emission = vectors(emission_.download(4));
  return cells;
}

}  // namespace volgi
