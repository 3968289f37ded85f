#pragma once
#include <vector>

#include "core/scene.h"
#include "screen/frame/stage.h"

namespace volgi::screen {

/// Passes of every picture carry these (screen/base): emission and sky seen, and punctual light with shadow maps.
inline constexpr LightPaths BASE_PATHS{LightPath::emission_seen, LightPath::sky_seen, LightPath::punctual_direct};

/// Which of a recipe's stages a picture needs.
struct Plan {
  struct Step {
    const StageType* type;
    std::vector<Product> taken;  // by steps after it
    std::vector<StageRole::Light> adds;
  };
  std::vector<Step> steps;
  LightPaths wanted;          // asked for, in the scene, and claimed by the recipe
  LightPaths missing;         // asked for and in the scene, but not claimed, or lacking with these options
  bool mirror_apart = false;  // some step adds LightShare::mirror
};

/// Paths that there can be in a scene: of punctual lights, of emissive surfaces; none without triangles.
LightPaths paths_in(const Scene& scene);

/// Chooses the stages, and refuses a recipe that does not add up. Knows nothing of OpenGL.
/// @param present  paths_in(scene). @param shines  the scene does: else nobody adds LightShare::mirror.
/// @throws Error(usage) naming stage and light: where a light path is in two layers, or in none although the recipe
///   claims it, or is not claimed; where a near share has no far one or a far one no near one, or a mirror's share is
///   all there is; where a stage needs what no stage before it makes; where slots are out of order.
Plan plan_picture(const Recipe& recipe, const FrameOptions& options, LightPaths present, bool shines = true);

/// @throws Error(usage) when `layers`, as the stage added them, are not what its role says.
void check_layers(const Plan::Step& step, std::span<const RadianceLayer> layers);

}  // namespace volgi::screen
