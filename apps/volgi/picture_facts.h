#pragma once
#include <optional>

#include "core/camera.h"
#include "core/scene.h"
#include "screen/frame/choice.h"

namespace volgi::app {

/// What `--gi auto` looks at: the scene, and two small traced pictures of what the camera sees of it.
/// Deterministic. Cost: scene_facts() and some 10^5 rays; once for a scene and camera.
screen::PictureFacts picture_facts(const Scene& scene, const Camera& camera, const SceneFacts& facts,
                                   const std::optional<GridBox>& box);

}  // namespace volgi::app
