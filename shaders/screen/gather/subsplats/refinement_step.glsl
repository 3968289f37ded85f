// Whether a subsplat gives way to its four parts, by discontinuities, or for one light by what it gives them.
#ifndef VOLGI_REFINEMENT_STEP_GLSL
#define VOLGI_REFINEMENT_STEP_GLSL
#include "screen/gather/subsplats/refined.glsl"

uniform int level;  // that this step looks at

Subsplat part_of(Subsplat s, int k) { return Subsplat(s.level - 1, 2 * s.texel + ivec2(k & 1, k >> 1)); }

bool is_there(Subsplat s) {
  return all(lessThan(s.texel, level_size(picture_size, s.level))) && has_surface(s);
}

#ifdef EACH_LIGHT
#include "screen/base/virtual_lights_block.glsl"
#include "screen/gather/subsplats/subsplat_light.glsl"
uniform float most_difference;  // T [W m^-2]

// §3.2.3.1: the light of the four quadrants differs in some component by more than T.
bool gives_way(Subsplat s, uint light) {
  if (s.level != level || s.level <= finest_level) return false;
  vec3 most = vec3(0.0), least = vec3(3.0e38);
  for (int k = 0; k < 4; ++k) {
    Subsplat part = part_of(s, k);
    if (any(greaterThanEqual(part.texel, level_size(picture_size, part.level)))) continue;
    Receiver at = receiver_of(part, picture_size, true);
    vec3 l = has_surface(at) ? light_at(lights[light], at) : vec3(0.0);
    most = max(most, l);
    least = min(least, l);
  }
  return any(greaterThan(most - least, vec3(most_difference)));
}
#else
bool gives_way(Subsplat s, uint light) { return s.level == level && is_refined(s); }
#endif

#endif
