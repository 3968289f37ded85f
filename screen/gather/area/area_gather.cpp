#include "screen/gather/area/area_gather.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>

#include "core/error.h"
#include "shaders/screen/gather/area/slots.shared.h"
#include "shaders/shared/group_sizes.shared.h"

namespace volgi::screen {

namespace {

constexpr const char* REFINE = "screen/gather/area/refine.comp.glsl";

void wait_for_pixels() {
  glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT |
                  GL_COMMAND_BARRIER_BIT);
}

}  // namespace

void AreaGather::check(const AreaGatherOptions& options) {
  const int n = options.coarsest;
  if (n < 1 || n > 32 || !std::has_single_bit(unsigned(n)))
    throw Error(ExitCode::usage, fmt::format("area.coarsest: 1, 2, 4, 8, 16 or 32 pixels, not {}", n));
}

AreaGather::AreaGather(glm::ivec2 size, const AreaGatherOptions& options)
    : size_(size),
      options_(options),
      irradiance_(gl::Texture::make_2d(GL_RGBA32F, size.x, size.y)),
      masks_{gl::Texture::make_2d(GL_RGBA32UI, size.x, size.y), gl::Texture::make_2d(GL_RGBA32UI, size.x, size.y)},
      gathered_step_(gl::Texture::make_2d(GL_R8UI, size.x, size.y)),
      radiance_(gl::Texture::make_2d(GL_RGBA32F, size.x, size.y)),
      counts_(2 * sizeof(GLuint)),
      first_(gl::Program::compute(REFINE, {"FIRST"})),
      finer_(gl::Program::compute(REFINE)),
      shade_(gl::Program::compute("screen/gather/area/shade.comp.glsl")) {
  check(options);
  for (int step = options.coarsest; step > 0; step /= 2) {
    lists_.emplace_back();
    lists_.back().reserve(size_t((size.x + step - 1) / step) * size_t((size.y + step - 1) / step));
  }
}

const gl::Program& AreaGather::gather_program(bool first, const Hidden& hidden) {
  const std::string hides = hidden.voxels != nullptr ? "VOXELS" : hidden.faces != nullptr ? "FACES" : "NOTHING";
  if (hides_ != hides) {
    hides_ = hides;
    gather_first_ = gl::Program::compute("screen/gather/area/gather.comp.glsl", {hides, "FIRST"});
    gather_finer_ = gl::Program::compute("screen/gather/area/gather.comp.glsl", {hides});
  }
  return first ? gather_first_ : gather_finer_;
}

void AreaGather::run(const GBuffer& gbuffer, const AreaLights& lights, const Hidden& hidden, gl::PassTimer& timer) {
  assert(lights.count() <= AREA_MASK_LIGHTS);
  {
    const auto scope = timer.scope(name);
    gbuffer.bind();
    counts_.clear();
    gathered_step_.clear({0.0f, 0.0f, 0.0f, 0.0f});
    int step_px = options_.coarsest;
    for (const WorkList& list : lists_) {
      refine(step_px, list);
      gather(step_px, lights, hidden, list);
      step_px /= 2;
    }
  }
  const auto scope = timer.scope(shade_name);
  irradiance_.bind(AREA_IRRADIANCE_UNIT);
  radiance_.bind_image(AREA_RADIANCE_IMAGE, GL_WRITE_ONLY);
  shade_.use();
  gl::dispatch({size_.x, size_.y, 1}, {SQUARE_GROUP, SQUARE_GROUP, 1});
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
}

void AreaGather::bind_pictures() const {
  irradiance_.bind(AREA_IRRADIANCE_UNIT);
  irradiance_.bind_image(AREA_IRRADIANCE_IMAGE, GL_WRITE_ONLY);
  for (GLuint k = 0; k < 2; ++k) {
    masks_[k].bind(AREA_MASK_UNIT + k);
    masks_[k].bind_image(AREA_MASK_IMAGE + k, GL_WRITE_ONLY);
  }
}

void AreaGather::refine(int step_px, const WorkList& list) {
  list.clear();
  list.bind(AREA_LIST_SLOT);
  bind_pictures();
  gathered_step_.bind_image(AREA_STEP_IMAGE, GL_WRITE_ONLY);
  const gl::Program& program = step_px == options_.coarsest ? first_ : finer_;
  program.set("step_px", step_px);
  program.set("tolerance", options_.tolerance);
  program.set("most_in_part", int(std::lround(options_.in_part * float(AREA_MASK_LIGHTS))));
  program.use();
  const glm::ivec2 grid = (size_ + step_px - 1) / step_px;
  gl::dispatch({grid.x, grid.y, 1}, {SQUARE_GROUP, SQUARE_GROUP, 1});
  wait_for_pixels();
}

void AreaGather::gather(int step_px, const AreaLights& lights, const Hidden& hidden, const WorkList& list) {
  const gl::Program& program = gather_program(step_px == options_.coarsest, hidden);
  if (hidden.voxels != nullptr) hidden.voxels->bind(program);
  if (hidden.faces != nullptr) {
    hidden.faces->voxels.bind();
    cells_.bind(hidden.faces->voxels);
  }
  list.bind(AREA_LIST_SLOT);
  lights.buffer().bind_storage(AREA_LIGHTS_SLOT);
  counts_.bind_storage(AREA_COUNTS_SLOT);
  bind_pictures();
  program.set("step_px", step_px);
  program.set("light_count", lights.count());
  program.set("incremental", options_.incremental ? 1 : 0);
  program.use();
  list.dispatch();
  wait_for_pixels();
}

AreaGather::Figures AreaGather::figures() const {
  Figures f{};
  double gathered = 0.0;
  int step = options_.coarsest;
  for (const WorkList& list : lists_) {
    const double here = double(list.count());
    const double across = double((size_.x + step - 1) / step) * double((size_.y + step - 1) / step);
    f.level.push_back(here / across);
    gathered += here;
    step /= 2;
  }
  const std::vector<GLuint> counts = counts_.download<GLuint>(2);
  f.gathered = gathered / (double(size_.x) * double(size_.y));
  f.ways = double(counts[1]);
  f.asked = double(counts[1]) / std::max(double(counts[0]), 1.0);
  return f;
}

size_t AreaGather::bytes() const {
  size_t bytes = (4 * 16 + 1) * size_t(size_.x) * size_t(size_.y) + counts_.bytes();
  for (const WorkList& list : lists_) bytes += list.bytes();
  return bytes;
}

}  // namespace volgi::screen
