#include "screen/gather/interleaved/worst_pixels.h"

#include <algorithm>

#include "shaders/screen/base/slots.shared.h"
#include "shaders/screen/gather/interleaved/exact_pixels.shared.h"
#include "shaders/screen/gather/interleaved/slots.shared.h"
#include "shaders/shared/group_sizes.shared.h"

namespace volgi::screen {

WorstPixels::WorstPixels(glm::ivec2 size)
    : size_(size),
      bins_((1 + ERROR_BINS) * sizeof(GLuint)),
      count_(gl::Program::compute("screen/gather/interleaved/exact_pixels_count.comp.glsl")),
      threshold_(gl::Program::compute("screen/gather/interleaved/exact_pixels_threshold.comp.glsl")),
      list_program_(gl::Program::compute("screen/gather/interleaved/exact_pixels_list.comp.glsl")) {
  list_.reserve(size_t(size.x) * size_t(size.y));
}

void WorstPixels::find(const gl::Texture& estimate, float rows) {
  list_.clear();
  bins_.clear();
  estimate.bind_image(ERROR_ESTIMATE_IMAGE, GL_READ_ONLY);
  list_.bind(PIXEL_LIST_SLOT);
  bins_.bind_storage(ERROR_BINS_SLOT);
  count_.use();
  gl::dispatch({size_.x, size_.y, 1}, {ERROR_TILE, ERROR_TILE, 1});
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  threshold_.set("max_pixels", GLuint(std::min(rows, float(size_.y)) * float(size_.x)));
  threshold_.use();
  gl::dispatch({1, 1, 1}, {1, 1, 1});
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  list_program_.use();
  gl::dispatch({size_.x, size_.y, 1}, {SQUARE_GROUP, SQUARE_GROUP, 1});
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

}  // namespace volgi::screen
