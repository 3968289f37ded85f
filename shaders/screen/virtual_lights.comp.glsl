#version 450 core
// One virtual light for each of the equal parts of one light's cone, or of a sun's rectangle. Cochran and Steele 2007,
// §3.1; flux and area: conventions.md, "VPL".
#include "screen/virtual_light_at.glsl"

layout(local_size_x = 64) in;
uniform mat3 world_from_axis;  // turns -Y to the light's axis
uniform float measure;         // of one part: solid angle [sr], of a sun area across the light [m^2]

// Direction of sample i, in the world.
vec3 direction_of(int i) { return world_from_axis * samples[first_sample + i].xyz; }

VirtualLight sample_cone(ReflectiveShadowLight l, int i) {
  vec3 direction = direction_of(i);
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

VirtualLight sample_sun(ReflectiveShadowLight l, int i) {
  ReflectiveShadowLayer view = rsm_layers[l.first_layer];
  float inner = 1.0 - 2.0 * float(RSM_MARGIN_TEXELS) / float(l.resolution);
  vec2 uv = (2.0 * samples[first_sample + i].xy - 1.0) * inner;
  ivec2 texel = clamp(ivec2(floor((uv * 0.5 + 0.5) * float(l.resolution))), ivec2(0), ivec2(l.resolution - 1));
  Meeting at;
  if (!meet(view, l.resolution, 0, uv, texel, at)) return no_light(view, uv);
  vec3 albedo = texelFetch(rsm_albedo, ivec3(at.texel, 0), 0).rgb;
  return VirtualLight(at.position, measure * area_of_measure(view, at), at.normal, VIRTUAL_LIGHT_REFLECTED,
                      l.light.intensity * measure * albedo, light);
}

void main() {
  int i = int(gl_GlobalInvocationID.x);
  if (i >= count) return;
  ReflectiveShadowLight l = rsm_lights[light];
  if (l.light.type == LIGHT_DIRECTIONAL) {
    virtual_lights[first + i] = sample_sun(l, i);
  } else {
    virtual_lights[first + i] = sample_cone(l, i);
  }
}
