#pragma once
#include "core/gl/program.h"
#include "shaders/screen/gather/subsplats/subsplat.shared.h"

namespace volgi::screen {

/// Levels of a picture: squares of 2^finest to 2^last pixels on a side.
struct SubsplatLevels {
  glm::ivec2 size{1};
  int last = 0;
  int finest = 0;

  /// @param cells   that the coarsest level has at least along the longer side, where the picture has as many pixels.
  /// @param finest_pixels  a power of two: on a side of the finest square; no level is finer, and one is there.
  static SubsplatLevels of(glm::ivec2 size, int cells, int finest_pixels) {
    SubsplatLevels levels{size, 0, 0};
    while ((1 << levels.finest) < finest_pixels && levels.finest < MAX_SUBSPLAT_LEVEL) ++levels.finest;
    const int longer = size.x > size.y ? size.x : size.y;
    while (levels.last < MAX_SUBSPLAT_LEVEL && (longer >> (levels.last + 1)) >= cells) ++levels.last;
    if (levels.last < levels.finest) levels.last = levels.finest;
    return levels;
  }
  glm::ivec2 flattened() const { return shared::flattened_size(size, last); }
  glm::ivec2 tower() const { return shared::tower_size(size, last); }
  /// As many subsplats as can cover the picture once.
  size_t most_fragments() const {
    const glm::ivec2 texels = shared::level_size(size, finest);
    return size_t(texels.x) * size_t(texels.y);
  }
  void set(const gl::Program& program) const {
    program.set("picture_size", size);
    program.set("last_level", last);
    program.set("finest_level", finest);
  }
};

}  // namespace volgi::screen
