#pragma once
#include <glm/glm.hpp>
#include <vector>

#include "core/scene.h"
#include "core/scene_detail.h"
#include "shaders/shared/reflective_shadow_map.shared.h"

namespace volgi {

/// The layers of one light's reflective shadow map, fitted to its cone or to the scene's bounds: 1 for a sun or a spot,
/// 6 for a point light or a spot wider than 60 degrees from its axis.
std::vector<shared::ReflectiveShadowLayer> reflective_shadow_layers(const Light& light, int resolution,
                                                                    glm::vec3 bounds_min, glm::vec3 bounds_max);

/// The layer of a sun whose picture is as wide as one box, with all that is between the sun and it.
/// @param all  the scene's bounds.
shared::ReflectiveShadowLayer layer_across(glm::vec3 direction, int resolution, const SceneBox& across,
                                           const SceneBox& all);

}  // namespace volgi
