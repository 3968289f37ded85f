// Reads reflective shadow maps as screen/base/reflective_shadow_map.cpp binds them: the data of all lights, the textures of
// one. `light` must be the light whose textures are bound.
#ifndef VOLGI_REFLECTIVE_SHADOW_MAP_GLSL
#define VOLGI_REFLECTIVE_SHADOW_MAP_GLSL
#include "shared/octahedral.glsl"
#include "shared/reflective_shadow_map.shared.h"

layout(std430, binding = RSM_LIGHTS_SLOT) readonly buffer RsmLights { ReflectiveShadowLight rsm_lights[]; };
layout(std430, binding = RSM_LAYERS_SLOT) readonly buffer RsmLayers { ReflectiveShadowLayer rsm_layers[]; };
layout(binding = RSM_DEPTH_UNIT) uniform sampler2DArray rsm_depth;
layout(binding = RSM_NORMAL_UNIT) uniform sampler2DArray rsm_normal;  // geometric, octahedral, on the light's side
layout(binding = RSM_ALBEDO_UNIT) uniform sampler2DArray rsm_albedo;  // coloured by the glass in front of it
// Set by the program: GLASS, where the scene has some
#ifdef GLASS
layout(binding = RSM_TINT_UNIT) uniform sampler2DArray rsm_tint;  // and the depth of the nearest pane
#endif

// What the light sees through one texel: position on the surface, geometric normal on the light's side, power that
// arrives there [W] (0 outside a spot's cone), albedo.
// @return false when nothing is there, or when another layer counts it.
bool rsm_texel(int light, int layer, ivec2 texel, out vec3 position, out vec3 normal_towards_light,
               out vec3 irradiance_flux, out vec3 albedo) {
  ReflectiveShadowLight l = rsm_lights[light];
  float depth = texelFetch(rsm_depth, ivec3(texel, layer), 0).r;
  if (depth <= 0.0 || !rsm_texel_counts(l.layer_count, l.resolution, texel.x, texel.y)) return false;
  ReflectiveShadowLayer view = rsm_layers[l.first_layer + layer];
  vec2 uv = (vec2(texel) + 0.5) * (2.0 / float(l.resolution)) - 1.0;
  position = rsm_position_from_uvz(view, vec3(uv, rsm_z_from_depth(view, depth)));
  normal_towards_light = octahedral_decode(texelFetch(rsm_normal, ivec3(texel, layer), 0).rg);
  albedo = texelFetch(rsm_albedo, ivec3(texel, layer), 0).rgb;
  vec3 radiant = l.light.intensity;  // towards the texel [W/sr]; directional: [W/m^2]
  if (l.light.type != LIGHT_DIRECTIONAL) {
    vec3 from_light = position - l.light.position;
    float distance = length(from_light);
    radiant *= range_window(l.light, distance);
    if (l.light.type == LIGHT_SPOT) radiant *= spot_falloff(l.light, from_light / max(distance, 1e-30));
  }
  irradiance_flux = radiant * rsm_texel_measure(view, l.resolution, uv.x, uv.y);
  return any(greaterThan(irradiance_flux, vec3(0.0)));
}

// Whether the surface in a texel hides `position` from the light. It does when it lies on the light's side of the
// receiver's plane, and the receiver lies behind the occluder's plane. Points of one plane fail both tests, facets of a
// convex surface the first and of a concave one the second, so that no bias is needed beyond what the numbers err:
// rasterizers place vertices to 1/256 of a texel, normals are rounded, and so are positions and depths (2^-20 allows
// for the interpolation of depth, 2^-23 alone is not reached).
bool rsm_texel_hides(ReflectiveShadowLayer view, int resolution, ivec3 texel, vec3 position, vec3 normal) {
  float depth = texelFetch(rsm_depth, texel, 0).r;
  if (depth <= 0.0) return false;
  float z = rsm_z_from_depth(view, depth);
  vec2 uv = (vec2(texel.xy) + 0.5) * (2.0 / float(resolution)) - 1.0;
  vec3 occluder = rsm_position_from_uvz(view, vec3(uv, z));
  vec3 occluder_normal = octahedral_decode(texelFetch(rsm_normal, texel, 0).rg);
  vec3 d = occluder - position;
  float range = view.directional != 0 ? view.depth_scale_m : z;
  float error = rsm_texel_size_m(view, resolution, z) / 256.0 + (range + length(position)) / 1048576.0 +
                length(d) * OCTAHEDRAL_ERROR_RAD;
  return dot(d, normal) > error && dot(d, occluder_normal) > error;
}

// What glass leaves of the light through a texel at distance z [m]: nothing is taken from what lies in front of the
// nearest pane, or on it, as near as 11 bits tell.
vec3 rsm_texel_tint(ReflectiveShadowLayer view, ivec3 texel, float z) {
#ifdef GLASS
  vec4 pane = texelFetch(rsm_tint, texel, 0);
  float rounded = (view.directional != 0 ? view.depth_scale_m : z) / 1024.0;
  bool behind = pane.a > 0.0 && z > rsm_z_from_depth(view, pane.a) + rounded;
  return behind ? pane.rgb : vec3(1.0);
#else
  return vec3(1.0);
#endif
}

// Share of the light that reaches `position`, between the four nearest texels. `normal` is the receiver's geometric one
// on the side that the light shines on.
vec3 rsm_visibility(int light, vec3 position, vec3 normal) {
  ReflectiveShadowLight l = rsm_lights[light];
  int layer = rsm_layer_of_direction(l.layer_count, position - l.light.position);
  ReflectiveShadowLayer view = rsm_layers[l.first_layer + layer];
  vec3 uvz = rsm_uvz_from_position(view, position);
  vec2 at = (uvz.xy * 0.5 + 0.5) * float(l.resolution) - 0.5;
  ivec2 first = ivec2(floor(at));
  vec2 t = at - vec2(first);
  vec3 visible = vec3(0.0);
  for (int k = 0; k < 4; ++k) {
    ivec2 corner = ivec2(k & 1, k >> 1);
    ivec2 texel = clamp(first + corner, ivec2(0), ivec2(l.resolution - 1));
    vec2 w = mix(1.0 - t, t, vec2(corner));
    if (!rsm_texel_hides(view, l.resolution, ivec3(texel, layer), position, normal))
      visible += w.x * w.y * rsm_texel_tint(view, ivec3(texel, layer), uvz.z);
  }
  return visible;
}

#endif
