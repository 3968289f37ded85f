#pragma once
#include <glm/glm.hpp>
#include <vector>

#include "core/scene.h"
#include "shaders/shared/reflective_shadow_map.shared.h"

namespace volgi {

/// How many of the virtual lights each source gets.
struct LightShares {
  std::vector<int> of_light;  // as Scene::lights
  int of_sky = 0;             // what surfaces reflect of it
  int of_emitters = 0;        // all emissive surfaces together
};

/// Area [m^2] across a sun's direction that its layer covers, without the margin: the bounds' rectangle.
double rectangle_of_sun_m2(const shared::ReflectiveShadowLayer& layer, int resolution);

/// Luminance of the power [W] that a light sends: into its cone, without range, or across the scene's bounds.
double power_luminance(const Light& light, glm::vec3 bounds_min, glm::vec3 bounds_max);

/// `count` shared in proportion to `power`: by largest remainder, earlier ones first among equals. What has any gets
/// one, and an eighth of an even share, at least; where one each is too many, the strongest get one.
std::vector<int> share_out(const std::vector<double>& power, int count);

/// Shares by the luminance of what sources send. That does not ask what light falls on, so shares stay while lights
/// move; only a sun that turns sees another rectangle. Suns and sky together get no more than lamps and emissive
/// surfaces do: theirs grows with the ground around a house, of which nobody in it sees anything.
/// @param emitted_flux  power of all emissive surfaces together [W]. @param with_sky  the sky is a source.
LightShares share_by_power(const Scene& scene, glm::dvec3 emitted_flux, int count, bool with_sky = true);
/// What lamps and emissive surfaces send over what suns and the sky do, or the other way round: at most 1, which it is
/// where there is only one of the two kinds. Emissive textures count as white.
double share_within(const Scene& scene);
/// `each` for every source that sends anything.
LightShares share_equally(const Scene& scene, glm::dvec3 emitted_flux, int each, bool with_sky = true);

}  // namespace volgi
