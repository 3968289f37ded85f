#include "screen/lights/light_choice.h"

#include "screen/sources/sky/sky_stage.h"

namespace volgi::screen {

LightPaths reflected_paths(const FrameOptions& options) {
  if (options.of<LightChoice>().stage == LightChoice::Stage::lattice)
    return {LightPath::punctual_first, LightPath::punctual_higher};
  const LightPaths punctual{LightPath::punctual_first};
  if (options.of<LightChoice>().stage == LightChoice::Stage::patches) return punctual;
  return sky_goes_by_lights(options) ? punctual | LightPaths{LightPath::sky_first} : punctual;
}

LightPaths paths_by_lights(const FrameOptions& options) {
  const bool emitters = options.of<LightChoice>().stage == LightChoice::Stage::rsm;
  return emitters ? reflected_paths(options) | LightPaths{LightPath::emission_direct} : reflected_paths(options);
}

}  // namespace volgi::screen
