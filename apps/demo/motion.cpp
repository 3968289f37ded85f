#include "apps/demo/motion.h"

#include <algorithm>
#include <cmath>

#include "propagation/volume_options.h"
#include "screen/base/reflective_shadow_map.h"
#include "screen/lights/resample/resample_stage.h"
#include "screen/lights/rsm/virtual_lights.h"
#include "screen/visibility/area_maps/area_maps_stage.h"
#include "screen/visibility/area_maps/virtual_area_lights.h"

namespace volgi::demo {

glm::ivec2 motion_size(int level, glm::ivec2 size) { return level == 0 ? size : glm::max(size / 2, glm::ivec2(1)); }

void apply_motion_level(int level, screen::FrameOptions& options) {
  if (level < 2) return;
  auto& candidates = options.of<screen::ResampleOptions>().candidates;
  candidates = std::max(std::min(candidates, 2), candidates / 4);
  auto& texels = options.of<screen::AreaMapOptions>().texels;
  texels = std::max(std::min(texels, 32), texels / 2);
  constexpr int ENOUGH_SHADOW = 256, ENOUGH_CELLS = 24;
  auto& shadows = options.of<screen::ReflectiveShadowMap::Resolution>();
  for (int* side : {&shadows.spot, &shadows.cube_face, &shadows.sun})
    *side = std::max(std::min(*side, ENOUGH_SHADOW), *side / 2);
  auto& cells = options.of<VolumeOptions>().grid_cells;
  cells = std::max(std::min(cells, ENOUGH_CELLS), cells * 2 / 3);
  if (level < 3) return;
  auto& lights = options.of<screen::VirtualLightOptions>().count;
  lights = std::max(lights / 2, 1);
  auto& clusters = options.of<screen::VirtualAreaLightOptions>().count;
  clusters = std::max(clusters / 2, 1);
}

void MotionPace::reset() {
  level_ = 0;
  slow_ = 0;
}

bool MotionPace::moving(Clock::time_point now) const {
  constexpr auto A_MOMENT = std::chrono::milliseconds(250);
  return now - moved_ < A_MOMENT;
}

void MotionPace::shown(double seconds, double least_fps) {
  if (least_fps <= 0.0) {
    reset();
    return;
  }
  constexpr int IN_A_ROW = 2;      // one slow frame may be anybody's
  constexpr double A_LEVEL = 2.0;  // times as fast, about
  const double too_slow = seconds * least_fps;
  slow_ = too_slow > 1.0 ? slow_ + 1 : 0;
  if (slow_ < IN_A_ROW) return;
  // A level that is passed over is one frame less that has to be made.
  level_ = std::min(level_ + std::max(1, int(std::log(too_slow) / std::log(A_LEVEL))), MOTION_LEVELS - 1);
  slow_ = 0;
}

}  // namespace volgi::demo
