#include "propagation/sweep_radiance_gl.h"

#include <fmt/format.h>

#include <algorithm>

#include "shaders/propagation/slots.shared.h"
#include "shaders/propagation/sweep.shared.h"
#include "shaders/shared/group_sizes.shared.h"

namespace volgi {

namespace {

constexpr int kColumnsPerRow = 1 << DIAGONAL_ROW_BITS;

int texels_of(const OrdinateSet& set) { return (3 * int(set.directions.size()) + 3) / 4; }

/// SharesBlock of sweep_radiance.comp.glsl.
gl::Buffer pack_shares(const OrdinateSet& set, Ordinates rule, float cell_size_m) {
  const bool characteristic = rule == Ordinates::characteristic;
  const size_t n = 3 * size_t(texels_of(set));
  std::vector<glm::vec4> emitted(n), downwind(characteristic ? 3 * n : n), weight(n), direction(n);
  for (size_t value = 0; value < 3 * set.directions.size(); ++value) {
    const size_t d = value / 3, k = value / 4;
    const auto component = glm::length_t(value % 4);
    const CellTransfer transfer = cell_transfer(rule, set.directions[d]);
    const glm::vec3 per_watt = radiance_per_watt(set, d, rule, cell_size_m);
    for (int a = 0; a < 3; ++a) {
      const size_t at = 3 * k + size_t(a);
      emitted[at][component] = set.emitted_share(d)[a];
      weight[at][component] = per_watt[a];
      direction[at][component] = set.directions[d][a];
      if (!characteristic) downwind[at][component] = transfer.share[0][a];  // the same from every face
      for (int b = 0; characteristic && b < 3; ++b) downwind[3 * at + size_t(b)][component] = transfer.share[a][b];
    }
  }
  for (const std::vector<glm::vec4>* part : {&downwind, &weight, &direction}) {
    emitted.insert(emitted.end(), part->begin(), part->end());
  }
  return gl::Buffer(emitted);
}

}  // namespace

SweepRadianceGl::SweepRadianceGl(const Grid& grid, const OrdinateSet& set, Ordinates rule)
    : grid_(grid),
      program_(gl::Program::compute("propagation/sweep_radiance.comp.glsl",
                                    {fmt::format("TEXELS {}", texels_of(set)),
                                     fmt::format("CHARACTERISTIC {}", int(rule == Ordinates::characteristic))})),
      shares_(pack_shares(set, rule, grid.cell_size_m)) {
  const int faces = rule == Ordinates::characteristic ? 3 : 1;
  for (gl::Texture& t : planes_) {
    t = gl::Texture::make_2d_array(GL_RGBA32F, grid.cells.x, grid.cells.y, texels_of(set) * faces);
    t.clear({0.0f, 0.0f, 0.0f, 0.0f});  // what lies outside the grid is read, and counts zero times
  }
  list_diagonals();
}

/// The cells of every diagonal i+j+k beside each other, so that none of a dispatch's invocations has nothing to do.
void SweepRadianceGl::list_diagonals() {
  const glm::ivec3 n = grid_.cells;
  std::vector<std::uint32_t> columns;
  for (int diagonal = 0; diagonal <= n.x + n.y + n.z - 3; ++diagonal) {
    first_cell_.push_back(int(columns.size()));
    for (int j = std::max(0, diagonal - (n.x - 1) - (n.z - 1)); j <= std::min(n.y - 1, diagonal); ++j) {
      for (int i = std::max(0, diagonal - j - (n.z - 1)); i <= std::min(n.x - 1, diagonal - j); ++i) {
        columns.push_back(std::uint32_t(i) | (std::uint32_t(j) << 16));
      }
    }
  }
  first_cell_.push_back(int(columns.size()));
  const int height = int(columns.size() / kColumnsPerRow) + 1;
  columns.resize(size_t(height) * kColumnsPerRow);
  column_map_ = gl::Texture::make_2d(GL_R32UI, kColumnsPerRow, height);
  glTextureSubImage2D(column_map_.id(), 0, 0, 0, kColumnsPerRow, height, GL_RED_INTEGER, GL_UNSIGNED_INT,
                      columns.data());
}

RadianceVolumeGl SweepRadianceGl::run(const gl::Texture& cell_word, const gl::Texture& side_light) {
  RadianceVolumeGl result(grid_, 4);
  shares_.bind_uniform(SHARES_BLOCK);
  cell_word.bind(CELL_WORD_UNIT);
  side_light.bind(SIDE_LIGHT_UNIT);
  column_map_.bind(COLUMN_MAP_UNIT);
  result.sh.bind_image(SWEEP_RADIANCE_IMAGE, GL_READ_WRITE);
  for (int octant = 0; octant < 8; ++octant) sweep(octant);  // no two may write one cell
  return result;
}

void SweepRadianceGl::sweep(int octant) {
  program_.use();
  program_.set("octant", octant);
  for (size_t diagonal = 0; diagonal + 1 < first_cell_.size(); ++diagonal) {
    const int count = first_cell_[diagonal + 1] - first_cell_[diagonal];
    program_.set("diagonal", int(diagonal));
    program_.set("first_cell", first_cell_[diagonal]);
    program_.set("cell_count", count);
    planes_[(diagonal + 1) & 1].bind(BEFORE_PLANE_UNIT);
    planes_[diagonal & 1].bind_image(THIS_PLANE_IMAGE, GL_WRITE_ONLY);
    gl::dispatch({count, 1, 1}, {LINEAR_GROUP, 1, 1});
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
  }
}

}  // namespace volgi
