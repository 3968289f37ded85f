#include "propagation/pulse_volume_gl.h"

#include <fmt/format.h>

#include "core/error.h"
#include "shaders/propagation/partial_sums.shared.h"
#include "shaders/propagation/slots.shared.h"
#include "shaders/shared/group_sizes.shared.h"

namespace volgi {

namespace {

constexpr glm::ivec3 kLocal{CELL_GROUP_X, CELL_GROUP_Y, CELL_GROUP_Z};

constexpr size_t kPartialsBytes = PARTIAL_SUMS * sizeof(glm::vec4);

/// A state of lobes: the three bands' stacked in z (lobes.glsl).
glm::ivec3 lobe_texels(const Grid& grid, int order) {
  return {grid.cells.x, grid.cells.y, (order == 1 ? 3 : 7) * grid.cells.z};
}
int coefficients(int order) { return order == 1 ? 4 : 9; }

const SchemeOptions& checked(const SchemeOptions& options) {
  if (carries_sides(options.scheme)) {
    throw Error(ExitCode::usage, "a pulse without orders is what lpv2009 and gaitatzes2010 are; use one of them");
  }
  return options;
}

}  // namespace

PulseVolumeGl::PulseVolumeGl(const Grid& grid, const SchemeOptions& options)
    : grid_(grid),
      options_(checked(options)),
      inject_(compile(options.injection == SchemeOptions::Injection::max ? "pulse_inject_max" : "pulse_inject")),
      pass_(compile(options.scheme == Scheme::lpv2009 ? "pulse_lpv" : "pulse_gaitatzes")),
      add_radiance_(compile("add_radiance")),
      sum_sent_(gl::Program::compute("propagation/sum_sent.comp.glsl")),
      sum_lobes_(compile("sum_in_flight")),
      sum_partials_(gl::Program::compute("propagation/sum_partials.comp.glsl")),
      radiance_(grid, coefficients(options.sh_order)),
      partials_(kPartialsBytes),
      sum_(sizeof(glm::vec4)),
      readback_(sizeof(glm::vec4), 2) {
  for (gl::Texture* t : {&lobes_[0], &lobes_[1], &accumulated_[0], &accumulated_[1]}) {
    *t = gl::Texture::make_3d(GL_RGBA32F, lobe_texels(grid, options.sh_order));
  }
}

gl::Program PulseVolumeGl::compile(const char* shader) const {
  return gl::Program::compute(fmt::format("propagation/{}.comp.glsl", shader),
                              {fmt::format("ORDER {}", options_.sh_order), "PULSE 1"});
}

void PulseVolumeGl::dispatch_cells() const {
  gl::dispatch(grid_.cells, kLocal);
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT);
}

void PulseVolumeGl::inject(const VoxelGridGl& voxels, const Cells& cells, const gl::Buffer& side_flux) {
  voxels.bind();
  if (!by_max()) sum_side_flux(side_flux);
  side_flux.bind_storage(SIDE_FLUX_SLOT);
  cells.normal_occupancy.bind(NORMAL_OCCUPANCY_UNIT);
  cells.emission.bind(CELL_EMISSION_UNIT);
  lobes_[current_].bind_image(NEXT_LOBES_IMAGE, GL_WRITE_ONLY);
  inject_.use();
  dispatch_cells();
  if (by_max()) sum_in_flight();  // what surfaces send is not what goes in
}

BounceReport PulseVolumeGl::run(const VoxelGridGl& voxels, const Cells& cells, const gl::Buffer& side_flux,
                                int iterations, gl::PassTimer& timer) {
  auto scope = timer.scope("propagation/propagate");
  inject(voxels, cells, side_flux);
  accumulated_[current_].clear({0.0f, 0.0f, 0.0f, 0.0f});
  if (options_.scheme == Scheme::gaitatzes2010) {
    cells.normal_occupancy.bind(NORMAL_OCCUPANCY_UNIT);
    cells.albedo.bind(CELL_ALBEDO_UNIT);
    pass_.set("constant_albedo", int(options_.constant_albedo));
  }
  for (int i = 0; i < iterations; ++i) pass();
  sum_in_flight();
  read_out();
  BounceReport report;
  report.passes = iterations;
  glm::vec4 sum;
  readback_.pop(&sum);
  report.sent = glm::vec3(sum);
  readback_.pop(&sum);
  report.left = glm::vec3(sum);
  return report;
}

void PulseVolumeGl::pass() {
  lobes_[current_].bind(LOBES_UNIT);
  accumulated_[current_].bind(ACCUMULATED_UNIT);
  lobes_[1 - current_].bind_image(NEXT_LOBES_IMAGE, GL_WRITE_ONLY);
  accumulated_[1 - current_].bind_image(NEXT_ACCUMULATED_IMAGE, GL_WRITE_ONLY);
  pass_.use();
  dispatch_cells();
  current_ = 1 - current_;
}

void PulseVolumeGl::sum_side_flux(const gl::Buffer& side_flux) {
  side_flux.bind_storage(SENT_SLOT);
  partials_.bind_storage(PARTIALS_SLOT);
  sum_.bind_storage(SUM_SLOT);
  sum_sent_.use();
  glDispatchCompute(PARTIAL_SUMS, 1, 1);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  sum_partials_.use();
  glDispatchCompute(1, 1, 1);
  readback_.push(sum_);
}

void PulseVolumeGl::sum_in_flight() {
  lobes_[current_].bind(LOBES_UNIT);
  partials_.bind_storage(PARTIALS_SLOT);
  sum_.bind_storage(SUM_SLOT);
  sum_lobes_.use();
  glDispatchCompute(PARTIAL_SUMS, 1, 1);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  sum_partials_.use();
  glDispatchCompute(1, 1, 1);
  readback_.push(sum_);
}

void PulseVolumeGl::read_out() {
  radiance_.sh.clear({0.0f, 0.0f, 0.0f, 0.0f});
  accumulated_[current_].bind(LOBES_UNIT);
  radiance_.sh.bind_image(LOBES_RADIANCE_IMAGE, GL_READ_WRITE);
  add_radiance_.use();
  // gaitatzes2010 accumulates what leaves surfaces; pixels read what arrives there.
  add_radiance_.set("odd_sign", options_.scheme == Scheme::gaitatzes2010 ? -1.0f : 1.0f);
  dispatch_cells();
}

size_t PulseVolumeGl::bytes_for(const Grid& grid, int sh_order) {
  const glm::ivec3 texels = lobe_texels(grid, sh_order);
  const size_t lobes = sizeof(glm::vec4) * size_t(texels.x) * size_t(texels.y) * size_t(texels.z);
  return 4 * lobes + RadianceVolumeGl::bytes_for(grid, coefficients(sh_order)) + kPartialsBytes;
}

}  // namespace volgi
