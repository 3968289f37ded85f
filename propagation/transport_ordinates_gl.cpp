#include "propagation/transport_ordinates_gl.h"

#include <fmt/format.h>

#include <algorithm>

namespace volgi {

namespace {

constexpr int kSidesARow = 1024;    // side_texel.glsl
constexpr int kColumnsARow = 1024;  // sweep.comp.glsl

int rows(size_t count, int a_row) { return std::max(1, int((count + size_t(a_row) - 1) / size_t(a_row))); }

int texels_of(int directions) { return (3 * directions / 8 + 3) / 4; }

}  // namespace

OrdinatesTransportGl::OrdinatesTransportGl(const Grid& grid, const SchemeOptions& options)
    : OrdinatesTransportGl(grid, choose_ordinates(grid.cells, options).directions,
                           choose_ordinates(grid.cells, options).rule) {}

OrdinatesTransportGl::OrdinatesTransportGl(const Grid& grid, int directions, Ordinates rule)
    : grid_(grid), rule_(rule), texels_(texels_of(directions)), shares_(pack_shares(ordinate_set(directions))) {
  prepare_ = gl::Program::compute("propagation/prepare_sweep.comp.glsl");
  sweep_ = gl::Program::compute("propagation/sweep.comp.glsl", defines(false));
  collect_ = gl::Program::compute("propagation/collect_octants.comp.glsl");
  const int faces = rule == Ordinates::characteristic ? 3 : 1;
  for (gl::Texture& t : planes_) {
    t = gl::Texture::make_2d_array(GL_RGBA32F, grid.cells.x, grid.cells.y, 8 * texels_ * faces);
    t.clear({0.0f, 0.0f, 0.0f, 0.0f});  // what lies outside the grid is read, and counts zero times
  }
  cell_word_ = gl::Texture::make_3d(GL_R32UI, grid.cells);
  list_diagonals();
}

std::vector<std::string> OrdinatesTransportGl::defines(bool radiance) const {
  return {fmt::format("TEXELS {}", texels_), fmt::format("CHARACTERISTIC {}", int(rule_ == Ordinates::characteristic)),
          fmt::format("RADIANCE {}", int(radiance))};
}

/// SharesBlock of sweep.comp.glsl.
gl::Buffer OrdinatesTransportGl::pack_shares(const OrdinateSet& set) const {
  const bool characteristic = rule_ == Ordinates::characteristic;
  const size_t n = 3 * size_t(texels_);
  std::vector<glm::vec4> emitted(n), downwind(characteristic ? 3 * n : n), weight(n), direction(n);
  for (size_t value = 0; value < 3 * set.directions.size(); ++value) {
    const size_t d = value / 3, k = value / 4;
    const auto component = glm::length_t(value % 4);
    const CellTransfer transfer = cell_transfer(rule_, set.directions[d]);
    const glm::vec3 per_watt = radiance_per_watt(set, d, rule_, grid_.cell_size_m);
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

/// The cells of every diagonal i+j+k beside each other, so that none of a dispatch's invocations has nothing to do.
void OrdinatesTransportGl::list_diagonals() {
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
  const int height = rows(columns.size(), kColumnsARow);
  columns.resize(size_t(height) * kColumnsARow);
  column_map_ = gl::Texture::make_2d(GL_R32UI, kColumnsARow, height);
  glTextureSubImage2D(column_map_.id(), 0, 0, 0, kColumnsARow, height, GL_RED_INTEGER, GL_UNSIGNED_INT, columns.data());
}

void OrdinatesTransportGl::prepare(const VoxelGridGl& voxels, const gl::Buffer& sent) {
  if (capacity_ != voxels.side_capacity) {
    capacity_ = voxels.side_capacity;
    side_light_ = gl::Texture::make_2d(GL_RGBA32F, kSidesARow, rows(capacity_, kSidesARow));
    arrived_ = gl::Texture::make_2d(GL_RGBA32F, 4 * kSidesARow, rows(capacity_, kSidesARow));
  }
  voxels.bind();
  sent.bind_storage(7);
  cell_word_.bind_image(0, GL_WRITE_ONLY);
  side_light_.bind_image(1, GL_WRITE_ONLY);
  prepare_.use();
  gl::dispatch_linear(std::max<size_t>(capacity_, cell_count(grid_)), 64);
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
  shares_.bind_uniform(1);
  cell_word_.bind(1);
  side_light_.bind(2);
  column_map_.bind(3);
}

void OrdinatesTransportGl::sweep(const gl::Program& program, int first_octant, int octants) {
  program.use();
  program.set("first_octant", first_octant);
  for (size_t diagonal = 0; diagonal + 1 < first_cell_.size(); ++diagonal) {
    const int count = first_cell_[diagonal + 1] - first_cell_[diagonal];
    program.set("diagonal", int(diagonal));
    program.set("first_cell", first_cell_[diagonal]);
    program.set("cell_count", count);
    planes_[(diagonal + 1) & 1].bind(0);
    planes_[diagonal & 1].bind_image(0, GL_WRITE_ONLY);
    gl::dispatch({count, octants, 1}, {64, 1, 1});
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
  }
}

void OrdinatesTransportGl::carry(const VoxelGridGl& voxels, const gl::Buffer& sent, const gl::Buffer& received,
                                 const BounceRules& /*rules*/, BounceReport& report) {
  prepare(voxels, sent);
  arrived_.bind_image(1, GL_WRITE_ONLY);
  sweep(sweep_, 0, 8);
  arrived_.bind(0);
  received.bind_storage(6);
  collect_.use();
  gl::dispatch_linear(capacity_, 64);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  report.passes += 1;
}

RadianceVolumeGl OrdinatesTransportGl::radiance(const VoxelGridGl& voxels, const gl::Buffer& sent) {
  if (!read_out_) read_out_ = gl::Program::compute("propagation/sweep.comp.glsl", defines(true));
  RadianceVolumeGl result(grid_, 4);
  prepare(voxels, sent);
  result.sh.bind_image(1, GL_READ_WRITE);
  for (int octant = 0; octant < 8; ++octant) sweep(*read_out_, octant, 1);  // no two may write one cell
  return result;
}

size_t OrdinatesTransportGl::bytes() const {
  const size_t columns = size_t(grid_.cells.x) * size_t(grid_.cells.y);
  const size_t layers = 8 * size_t(texels_) * (rule_ == Ordinates::characteristic ? 3 : 1);
  return 2 * 16 * columns * layers + 8 * cell_count(grid_) + 80 * size_t(capacity_) + shares_.bytes();
}

}  // namespace volgi
