#include "screen/base/smooth_pixels.h"

#include <fmt/format.h>

#include <bit>
#include <cassert>
#include <cmath>

#include "core/error.h"
#include "shaders/screen/base/slots.shared.h"
#include "shaders/shared/group_sizes.shared.h"

namespace volgi::screen {

namespace {

void wait_for_pixels() {
  glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT |
                  GL_COMMAND_BARRIER_BIT);
}

}  // namespace

void SmoothPixels::check(const SmoothPixelOptions& options) {
  const int n = options.coarsest;
  if (n < 1 || n > 32 || !std::has_single_bit(unsigned(n))) {
    throw Error(ExitCode::usage,
                fmt::format("the coarsest grid of gathered pixels: 1, 2, 4, 8, 16 or 32 of them, not {}", n));
  }
  if (!(options.tolerance >= 0.0f && std::isfinite(options.tolerance)))
    throw Error(ExitCode::usage, "what interpolated pixels may err by must be 0 or more");
}

SmoothPixels::SmoothPixels(glm::ivec2 size, const SmoothPixelOptions& options)
    : options_(options),
      size_(size),
      gathered_step_(gl::Texture::make_2d(GL_R8UI, size.x, size.y)),
      mean_(sizeof(float)) {
  check(options);
  for (int step = options.coarsest; step > 0; step /= 2) {
    lists_.emplace_back();
    lists_.back().reserve(size_t((size.x + step - 1) / step) * size_t((size.y + step - 1) / step));
  }
}

const SmoothPixels::Programs& SmoothPixels::programs_for(size_t pictures) {
  assert(pictures > 0 && pictures <= SMOOTH_PICTURES);
  programs_.resize(std::max(programs_.size(), pictures + 1));
  if (!programs_[pictures]) {
    const std::string count = fmt::format("PICTURES {}", pictures);
    const auto refining = [&](std::initializer_list<const char*> modes) {
      std::vector<std::string> defines(modes.begin(), modes.end());
      defines.push_back(count);
      return gl::Program::compute("screen/base/smooth_pixels.comp.glsl", defines);
    };
    programs_[pictures] = Programs{refining({}),
                                   refining({"ALONG"}),
                                   refining({"BETWEEN"}),
                                   refining({"ALONG", "INNER_NEIGHBOURS"}),
                                   refining({"BETWEEN", "INNER_NEIGHBOURS"}),
                                   gl::Program::compute("screen/base/smooth_pixels_mean.comp.glsl", {count}),
                                   gl::Program::compute("screen/base/smooth_pixels_shade.comp.glsl", {count})};
  }
  return *programs_[pictures];
}

void SmoothPixels::run(const GBuffer& gbuffer, std::span<SmoothLight* const> lights, gl::PassTimer& timer) {
  std::vector<const gl::Texture*> radiance;
  std::vector<size_t> counts;
  for (const SmoothLight* light : lights) {
    const std::vector<const gl::Texture*> own = light->radiance();
    radiance.insert(radiance.end(), own.begin(), own.end());
    counts.push_back(own.size());
  }
  if (radiance.empty()) return;
  make_room(radiance.size());
  const Programs& programs = programs_for(radiance.size());
  gathered_step_.clear({0.0f, 0.0f, 0.0f, 0.0f});
  int step_px = options_.coarsest;
  for (const WorkList& list : lists_) {
    {
      const auto scope = timer.scope(name);
      gbuffer.bind();
      bind(radiance.size());
      if (step_px < options_.coarsest && step_px * 2 == options_.coarsest) find_mean(programs.mean);
      refine(programs, step_px, list);
    }
    size_t first = 0;
    for (size_t k = 0; k < lights.size(); first += counts[k++])
      lights[k]->gather(list, step_px, std::span(irradiance_).subspan(first, counts[k]), timer);
    wait_for_pixels();
    step_px /= 2;
  }
  const auto scope = timer.scope(name);
  gbuffer.bind();
  shade(programs.shade, radiance);
}

void SmoothPixels::make_room(size_t pictures) {
  while (irradiance_.size() < pictures) irradiance_.push_back(gl::Texture::make_2d(GL_RGBA32F, size_.x, size_.y));
}

void SmoothPixels::bind(size_t pictures) const {
  for (size_t k = 0; k < pictures; ++k) {
    irradiance_[k].bind(GLuint(SMOOTH_IRRADIANCE_UNIT + k));
    irradiance_[k].bind_image(GLuint(SMOOTH_IRRADIANCE_IMAGE + k), GL_WRITE_ONLY);
  }
  gathered_step_.bind_image(SMOOTH_STEP_IMAGE, GL_WRITE_ONLY);
  mean_.bind_storage(SMOOTH_MEAN_SLOT);
}

void SmoothPixels::refine(const Programs& programs, int step_px, const WorkList& list) {
  list.clear();
  list.bind(PIXEL_LIST_SLOT);
  if (step_px == options_.coarsest) {
    dispatch(programs.first, step_px, step_px, {0, 0});
  } else {
    const gl::Program& along = step_px == 1 ? programs.last_along : programs.along;
    dispatch(along, step_px, 2 * step_px, {1, 0});
    dispatch(along, step_px, 2 * step_px, {0, 1});
    dispatch(step_px == 1 ? programs.last_between : programs.between, step_px, 2 * step_px, {1, 1});
  }
  wait_for_pixels();
}

void SmoothPixels::dispatch(const gl::Program& program, int step_px, int every, glm::ivec2 odd) const {
  program.set("step_px", step_px);
  program.set("odd", odd);
  program.set("tolerance", options_.tolerance);
  program.set("min_cosine", options_.min_cosine);
  program.set("off_plane", options_.off_plane);
  program.use();
  const glm::ivec2 grid = (size_ + every - 1) / every;
  gl::dispatch({grid.x, grid.y, 1}, {SQUARE_GROUP, SQUARE_GROUP, 1});
}

void SmoothPixels::find_mean(const gl::Program& program) {
  program.set("step_px", options_.coarsest);
  program.use();
  gl::dispatch({1, 1, 1}, {1, 1, 1});
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

void SmoothPixels::shade(const gl::Program& program, const std::vector<const gl::Texture*>& radiance) const {
  for (size_t k = 0; k < radiance.size(); ++k) {
    irradiance_[k].bind(GLuint(SMOOTH_IRRADIANCE_UNIT + k));
    radiance[k]->bind_image(GLuint(SMOOTH_IRRADIANCE_IMAGE + k), GL_WRITE_ONLY);
  }
  program.use();
  gl::dispatch({size_.x, size_.y, 1}, {SQUARE_GROUP, SQUARE_GROUP, 1});
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
}

double SmoothPixels::gathered_share() const {
  double gathered = 0.0;
  for (const WorkList& list : lists_) gathered += double(list.count());
  return gathered / (double(size_.x) * double(size_.y));
}

void SmoothPixels::list_textures(std::vector<NamedTexture>& list) const {
  list_texture(list, name, "step", gathered_step_);
  constexpr const char* NAMES[SMOOTH_PICTURES] = {"irradiance 0", "irradiance 1", "irradiance 2", "irradiance 3"};
  for (size_t k = 0; k < irradiance_.size(); ++k) list_texture(list, name, NAMES[k], irradiance_[k]);
}

size_t SmoothPixels::bytes() const {
  size_t bytes = mean_.bytes() + (1 + sizeof(glm::vec4) * irradiance_.size()) * size_t(size_.x) * size_t(size_.y);
  for (const WorkList& list : lists_) bytes += list.bytes();
  return bytes;
}

}  // namespace volgi::screen
