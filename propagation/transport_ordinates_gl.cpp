#include "propagation/transport_ordinates_gl.h"

#include <fmt/format.h>

#include <algorithm>

#include "propagation/rim_inflow.h"
#include "shaders/propagation/slots.shared.h"
#include "shaders/propagation/sweep.shared.h"
#include "shaders/shared/group_sizes.shared.h"

namespace volgi {

namespace {

constexpr int kSidesPerRow = 1 << SIDE_ROW_BITS;
constexpr int kArrivedARow = 1 << ARRIVED_ROW_BITS;
constexpr int kOctantsOfSide = 4;  // that can reach it
constexpr int kBlocksARow = 1 << DIAGONAL_ROW_BITS;

int rows(size_t count, int per_row) { return std::max(1, int((count + size_t(per_row) - 1) / size_t(per_row))); }

int quads_of(int directions) { return (directions / 8 + 3) / 4; }

/// Texels that sweep.comp.glsl needs for a plane of faces across `axis`.
glm::ivec3 plane_texels(const Grid& grid, int lanes, int axis) {
  const glm::ivec3 n = grid.cells;
  return {8 * lanes, axis == 0 ? n.y : n.x, axis == 2 ? n.y : n.z};
}

}  // namespace

OrdinatesTransportGl::OrdinatesTransportGl(const Grid& grid, const SchemeOptions& options)
    : OrdinatesTransportGl(grid, choose_ordinates(grid.cells, options), choose_source_ordinates(grid.cells, options)) {}

OrdinatesTransportGl::OrdinatesTransportGl(const Grid& grid, int directions, Ordinates rule)
    : OrdinatesTransportGl(grid, {directions, rule}, std::nullopt) {}

OrdinatesTransportGl::OrdinatesTransportGl(const Grid& grid, OrdinateChoice choice,
                                           std::optional<OrdinateChoice> sources)
    : grid_(grid),
      choice_(choice),
      lanes_(3 * quads_of(choice.directions)),
      prepare_(gl::Program::compute("propagation/prepare_sweep.comp.glsl")),
      collect_(gl::Program::compute("propagation/collect_octants.comp.glsl")),
      all_(make_angles(choice)) {
  if (sources) sources_ = make_angles(*sources);
  for (int axis = 0; axis < 3; ++axis)
    faces_[axis] = gl::Texture::make_3d(GL_RGBA32F, plane_texels(grid, lanes_, axis));
  cell_word_ = gl::Texture::make_3d(GL_R32UI, grid.cells);
  list_blocks();
}

namespace {

/// QuadShares of sweep.comp.glsl, of the octant's directions from `first` on.
gl::Buffer pack_shares(const OrdinateSet& set, Ordinates rule, size_t first, size_t quads) {
  const bool characteristic = rule == Ordinates::characteristic;
  const size_t a_quad = characteristic ? 12 : 6;
  std::vector<glm::vec4> shares(a_quad * quads, glm::vec4(0.0f));
  for (size_t i = 0; i < 4 * quads && first + i < set.directions.size(); ++i) {
    const size_t d = first + i;
    const CellTransfer transfer = cell_transfer(rule, set.directions[d]);
    const auto component = glm::length_t(i % 4);
    glm::vec4* const quad = &shares[a_quad * (i / 4)];
    for (int a = 0; a < 3; ++a) {
      quad[a][component] = set.emitted_share(d)[a];
      if (!characteristic) quad[3 + a][component] = transfer.share[0][a];  // the same from every face
      for (int b = 0; characteristic && b < 3; ++b) quad[3 + 3 * a + b][component] = transfer.share[a][b];
    }
  }
  return gl::Buffer(shares);
}

}  // namespace

OrdinatesTransportGl::Angles OrdinatesTransportGl::make_angles(OrdinateChoice choice) const {
  const OrdinateSet set = ordinate_set(choice.directions);
  const size_t quads = size_t(lanes_ / 3);
  Angles angles{choice, {}, {}, {}, 0};
  angles.sweep = gl::Program::compute(
      "propagation/sweep.comp.glsl", {fmt::format("QUADS {}", quads),
                                      fmt::format("CHARACTERISTIC {}", int(choice.rule == Ordinates::characteristic))});
  for (size_t first = 0; first < set.directions.size(); first += 4 * quads) {
    angles.shares.push_back(pack_shares(set, choice.rule, first, quads));
    angles.inflow.emplace_back(3 * 8 * size_t(lanes_) * sizeof(glm::vec4));
  }
  return angles;
}

/// The blocks of every diagonal i+j+k beside each other.
void OrdinatesTransportGl::list_blocks() {
  const glm::ivec3 n = (grid_.cells + (SWEEP_BLOCK - 1)) / SWEEP_BLOCK;
  std::vector<std::uint32_t> blocks;
  for (int diagonal = 0; diagonal <= n.x + n.y + n.z - 3; ++diagonal) {
    first_block_.push_back(int(blocks.size()));
    for (int k = 0; k < n.z; ++k) {
      for (int j = 0; j < n.y; ++j) {
        const int i = diagonal - j - k;
        if (i >= 0 && i < n.x) blocks.push_back(std::uint32_t(i) | std::uint32_t(j) << 8 | std::uint32_t(k) << 16);
      }
    }
  }
  first_block_.push_back(int(blocks.size()));
  const int height = rows(blocks.size(), kBlocksARow);
  blocks.resize(size_t(height) * kBlocksARow);
  block_list_ = gl::Texture::make_2d(GL_R32UI, kBlocksARow, height);
  glTextureSubImage2D(block_list_.id(), 0, 0, 0, kBlocksARow, height, GL_RED_INTEGER, GL_UNSIGNED_INT, blocks.data());
}

void OrdinatesTransportGl::prepare(const VoxelGridGl& voxels, const gl::Buffer& sent) {
  if (capacity_ != voxels.side_capacity) {
    capacity_ = voxels.side_capacity;
    side_light_ = gl::Texture::make_2d(GL_RGBA32F, kSidesPerRow, rows(capacity_, kSidesPerRow));
    arrived_ = gl::Texture::make_2d(GL_R32F, kArrivedARow * kOctantsOfSide * lanes_, rows(capacity_, kArrivedARow));
  }
  voxels.bind();
  sent.bind_storage(SENT_SLOT);
  cell_word_.bind_image(CELL_WORD_IMAGE, GL_WRITE_ONLY);
  side_light_.bind_image(SIDE_LIGHT_IMAGE, GL_WRITE_ONLY);
  prepare_.use();
  gl::dispatch_linear(std::max<size_t>(capacity_, cell_count(grid_)), LINEAR_GROUP);
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
}

void OrdinatesTransportGl::carry_sources(bool on) { of_sources_ = on; }

void OrdinatesTransportGl::stream_in(const Sky* sky) {
  streams_in_ = sky != nullptr;
  if (sky == nullptr) return;
  make_inflow(*sky, all_);
  if (sources_) make_inflow(*sky, *sources_);
}

void OrdinatesTransportGl::make_inflow(const Sky& sky, Angles& angles) const {
  if (sky.id() == angles.inflow_of) return;
  angles.inflow_of = sky.id();
  const OrdinateSet set = ordinate_set(angles.choice.directions);
  const std::vector<glm::vec3> flux = rim_inflow(sky, set);
  const size_t n = set.directions.size(), quads = size_t(lanes_ / 3);
  for (size_t batch = 0; batch < angles.inflow.size(); ++batch) {
    std::vector<glm::vec4> values(8 * size_t(lanes_) * 3, glm::vec4(0.0f));
    for (size_t octant = 0; octant < 8; ++octant) {
      for (size_t i = 0; i < 4 * quads && 4 * quads * batch + i < n; ++i) {
        const size_t d = 4 * quads * batch + i;
        const glm::vec3 per_flux = inflow_per_flux(set, d, grid_.cell_size_m);
        for (size_t band = 0; band < 3; ++band) {
          const size_t lane = octant * size_t(lanes_) + band * quads + i / 4;
          for (size_t axis = 0; axis < 3; ++axis)
            values[3 * lane + axis][glm::length_t(i % 4)] =
                per_flux[glm::length_t(axis)] * flux[octant * n + d][glm::length_t(band)];
        }
      }
    }
    gl::put(angles.inflow[batch], values);
  }
}

void OrdinatesTransportGl::sweep(size_t batch) {
  const gl::Program& program = angles().sweep;
  angles().shares[batch].bind_storage(SHARES_SLOT);
  angles().inflow[batch].bind_storage(INFLOW_SLOT);
  program.set("streams_in", streams_in_ ? 1 : 0);
  cell_word_.bind(CELL_WORD_UNIT);
  side_light_.bind(SIDE_LIGHT_UNIT);
  block_list_.bind(BLOCK_LIST_UNIT);
  for (GLuint axis = 0; axis < 3; ++axis) faces_[axis].bind_image(FACES_IMAGE + axis, GL_READ_WRITE);
  arrived_.bind_image(ARRIVED_IMAGE, GL_WRITE_ONLY);
  program.use();
  for (size_t diagonal = 0; diagonal + 1 < first_block_.size(); ++diagonal) {
    program.set("first_block", first_block_[diagonal]);
    glDispatchCompute(GLuint(first_block_[diagonal + 1] - first_block_[diagonal]), 1, 1);
    glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
  }
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
}

void OrdinatesTransportGl::carry(const VoxelGridGl& voxels, const gl::Buffer& sent, const gl::Buffer& received,
                                 const BounceRules& /*rules*/, BounceReport& report) {
  prepare(voxels, sent);
  for (size_t batch = 0; batch < angles().shares.size(); ++batch) {
    sweep(batch);
    arrived_.bind(ARRIVED_UNIT);
    received.bind_storage(RECEIVED_SLOT);
    collect_.use();
    collect_.set("lanes", lanes_);
    gl::dispatch_linear(capacity_, LINEAR_GROUP);
    // The next batch's arrivals take the place of those that have been read.
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
  }
  report.passes += 1;
}

RadianceVolumeGl OrdinatesTransportGl::radiance(const VoxelGridGl& voxels, const gl::Buffer& sent) {
  if (!read_out_) read_out_ = std::make_unique<SweepRadianceGl>(grid_, ordinate_set(choice_.directions), choice_.rule);
  prepare(voxels, sent);
  return read_out_->run(cell_word_, side_light_);
}

size_t OrdinatesTransportGl::bytes() const { return bytes_for(grid_, choice_, capacity_); }

size_t OrdinatesTransportGl::bytes_for(const Grid& grid, OrdinateChoice choice, std::uint32_t side_capacity) {
  const int lanes = 3 * quads_of(choice.directions);
  size_t sum = sizeof(std::uint32_t) * cell_count(grid);
  for (int axis = 0; axis < 3; ++axis) {
    const glm::ivec3 texels = plane_texels(grid, lanes, axis);
    sum += sizeof(glm::vec4) * size_t(texels.x) * size_t(texels.y) * size_t(texels.z);
  }
  const size_t a_side = sizeof(glm::vec4) + sizeof(float) * size_t(kOctantsOfSide * lanes);
  return sum + a_side * side_capacity;
}

size_t OrdinatesTransportGl::moved_bytes_for(const Grid& grid, OrdinateChoice choice, size_t sides) {
  constexpr size_t kOctants = 8;
  const size_t lanes = 3 * size_t(quads_of(choice.directions));
  const size_t cells = cell_count(grid);
  // Of a tile of 4 x 4 x 8 cells 4 x 4 faces across z, 4 x 8 across x and y each: 5 texels for every 8 cells.
  const size_t planes = 2 * sizeof(glm::vec4) * kOctants * lanes * (5 * cells / 8);
  const size_t a_side = kOctantsOfSide * (sizeof(glm::vec4) + 2 * sizeof(float) * lanes);
  return planes + kOctants * sizeof(std::uint32_t) * cells + a_side * sides;
}

}  // namespace volgi
