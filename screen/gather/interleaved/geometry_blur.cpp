#include "screen/gather/interleaved/geometry_blur.h"

#include "shaders/screen/gather/interleaved/slots.shared.h"
#include "shaders/shared/group_sizes.shared.h"

namespace volgi::screen {

GeometryBlur::GeometryBlur(glm::ivec2 size, int interleave, const GeometryBlurOptions& options)
    : size_(size),
      interleave_(interleave),
      options_(options),
      half_blurred_(gl::Texture::make_2d(GL_RGBA32F, size.x, size.y)),
      error_estimate_(gl::Texture::make_2d(GL_R32F, size.x, size.y)),
      program_(gl::Program::compute("screen/gather/interleaved/geometry_blur.comp.glsl")) {}

void GeometryBlur::run(const gl::Texture& from, const gl::Texture& to, Estimate estimate, float scene_diagonal_m) {
  error_estimate_.bind_image(BLUR_ERROR_IMAGE, GL_READ_WRITE);
  program_.set("interleave", interleave_);
  program_.set("max_distance_m", options_.distance * scene_diagonal_m);
  program_.set("min_cosine", options_.cosine);
  program_.set("off_plane", options_.off_plane);
  program_.set("adds", estimate == Estimate::adds ? 1 : 0);
  program_.use();
  const auto along = [&](glm::ivec2 axis, const gl::Texture& source, const gl::Texture& target, bool ends) {
    source.bind(BLUR_SOURCE_UNIT);
    target.bind_image(BLURRED_IMAGE, GL_WRITE_ONLY);
    program_.set("axis", axis);
    program_.set("ends", ends ? 1 : 0);
    gl::dispatch({size_.x, size_.y, 1}, {SQUARE_GROUP, SQUARE_GROUP, 1});
    glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT);
  };
  along({1, 0}, from, half_blurred_, false);
  along({0, 1}, half_blurred_, to, true);
}

glm::ivec2 place_in_block(int subset, int n) {
  glm::ivec2 place(0);
  for (int step = n / 2; step >= 1; step /= 2, subset /= 4) {
    place.x += ((subset ^ (subset >> 1)) & 1) * step;
    place.y += (subset & 1) * step;
  }
  return place;
}

}  // namespace volgi::screen
