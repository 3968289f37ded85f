// The virtual light that stands for one part of what a punctual light sends. Cochran and Steele 2007, §3.1; flux and
// area: docs/conventions.md#virtual-lights.
#include "shared/constants.glsl"
#include "screen/lights/rsm/virtual_light_at.glsl"

uniform mat3 world_from_axis;  // turns -Y to the light's axis
uniform float cone_height;     // 1 - cos of half the cone

// @param direction  unit, world.
// @param measure    of the part [sr].
VirtualLight sample_cone(ReflectiveShadowLight l, vec3 direction, float measure) {
  int layer = rsm_layer_of_direction(l.layer_count, direction);
  ReflectiveShadowLayer view = rsm_layers[l.first_layer + layer];
  float z = max(dot(direction, view.forward), 1e-30);
  vec2 uv = vec2(dot(direction, view.right) / view.extent_x, dot(direction, view.up) / view.extent_y) / z;
  ivec2 texel = clamp(ivec2(floor((uv * 0.5 + 0.5) * float(l.resolution))), ivec2(0), ivec2(l.resolution - 1));
  Meeting at;
  if (!meet(view, l.resolution, layer, uv, texel, at)) return no_light(view, uv);
  float falloff = l.light.type == LIGHT_SPOT ? spot_falloff(l.light, direction) : 1.0;
  vec3 arriving = l.light.intensity * (falloff * range_window(l.light, distance(at.position, view.origin)) * measure);
  vec3 albedo = texelFetch(rsm_albedo, ivec3(at.texel, layer), 0).rgb;
  return VirtualLight(at.position, measure * area_of_measure(view, at), at.normal, VIRTUAL_LIGHT_REFLECTED,
                      arriving * albedo, light);
}

// @param place    in the unit square: the sun's rectangle.
// @param measure  of the part, across the light [m^2].
VirtualLight sample_sun(ReflectiveShadowLight l, vec2 place, float measure) {
  ReflectiveShadowLayer view = rsm_layers[l.first_layer];
  float inner = 1.0 - 2.0 * float(RSM_MARGIN_TEXELS) / float(l.resolution);
  vec2 uv = (2.0 * place - 1.0) * inner;
  ivec2 texel = clamp(ivec2(floor((uv * 0.5 + 0.5) * float(l.resolution))), ivec2(0), ivec2(l.resolution - 1));
  Meeting at;
  if (!meet(view, l.resolution, 0, uv, texel, at)) return no_light(view, uv);
  vec3 albedo = texelFetch(rsm_albedo, ivec3(at.texel, 0), 0).rgb;
  return VirtualLight(at.position, measure * area_of_measure(view, at), at.normal, VIRTUAL_LIGHT_REFLECTED,
                      l.light.intensity * measure * albedo, light);
}

// Part of the unit square, which maps to the light's cone by azimuth and height over the axis: equal areas to equal
// solid angles (Archimedes); or to the sun's rectangle.
VirtualLight sample_place(ReflectiveShadowLight l, vec2 place, float measure) {
  if (l.light.type == LIGHT_DIRECTIONAL) return sample_sun(l, place, measure);
  float azimuth = 2.0 * PI * (place.x - 0.5);
  float height = cone_height * place.y;
  float radius = sqrt(max(height * (2.0 - height), 0.0));
  vec3 direction = vec3(radius * cos(azimuth), height - 1.0, radius * sin(azimuth));
  return sample_cone(l, world_from_axis * direction, measure);
}
