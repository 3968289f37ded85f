#pragma once
#include "core/gl/objects.h"
#include "core/gl/program.h"
#include "screen/base/work_list.h"

namespace volgi::screen {

/// The pixels with the largest error estimates: a histogram, a threshold, a list. Part of its callers' passes.
class WorstPixels {
 public:
  explicit WorstPixels(glm::ivec2 size);
  /// @param estimate  R32F of the picture's size. @param rows  at most as many pixels as so many rows hold.
  void find(const gl::Texture& estimate, float rows);
  const WorkList& list() const { return list_; }  // pixels: coarse_pixels.glsl
  size_t bytes() const { return bins_.bytes() + list_.bytes(); }

 private:
  glm::ivec2 size_;
  gl::Buffer bins_;  // uint: threshold, then pixels in each bin of the error estimate (exact_pixels.glsl)
  WorkList list_;
  gl::Program count_, threshold_, list_program_;
};

}  // namespace volgi::screen
