#pragma once
#include "core/gl/objects.h"
#include "core/gl/pass_timer.h"
#include "core/gl/program.h"

namespace volgi::screen {

/// Pass "screen/display/fxaa": fast approximate anti-aliasing of a picture as displays show it. Pixels at edges take
/// from the neighbour across the edge by how near the edge's next step is, up to 32 pixels away; others stay as they
/// are, to the bit. For looking at one frame: it knows no more than the picture does, and softens texture and what is
/// thinner than a pixel. Cost: five texels a pixel, at edges up to 58. Source: T. Lottes, "FXAA", NVIDIA white paper
/// 2009, and the notes to version 3.11; lumas are weighted sums of all three channels.
class Fxaa {
 public:
  static constexpr const char* name = "screen/display/fxaa";
  Fxaa();
  /// @param picture  RGBA8, sRGB encoded. @param target  of its size, over another texture.
  void run(const gl::Texture& picture, const gl::Framebuffer& target, gl::PassTimer& timer);

 private:
  gl::Program program_;
};

}  // namespace volgi::screen
