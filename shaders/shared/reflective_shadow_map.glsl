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

struct RsmReceiver {
  vec3 position;
  vec3 normal;     // geometric, on the side that the light shines on
  vec3 to_viewer;  // unit
};

// How the surface in a texel hides a point from the light.
struct RsmOccluder {
  bool hides;
  bool at_edge;  // it would, but lies so near to the receiver's plane that numbers cannot tell on which side
  bool beyond;   // nothing is there, or what is lies behind the receiver's plane: an edge of what the light sees is near
  float crease;  // across the light, in texels, how far the line is where the two planes meet
};
#define NO_CREASE 1e30  // facets of one bent surface have none

// The surface in a texel hides a point when it lies on the light's side of the receiver's plane, and the receiver lies
// behind the occluder's plane. Points of one plane fail both tests, facets of a convex surface the first and of a concave
// one the second, so that no bias is needed beyond what the numbers err: rasterizers place vertices to 1/256 of a texel,
// normals are rounded, and so are positions and depths (2^-20 allows for the interpolation of depth, 2^-23 alone is not
// reached). On the line where two surfaces meet, what the numbers err is decided towards the viewer, who is on the
// visible side of both.
RsmOccluder rsm_occluder(ReflectiveShadowLayer view, int resolution, ivec3 texel, RsmReceiver x) {
  RsmOccluder none = RsmOccluder(false, false, true, NO_CREASE);
  float depth = texelFetch(rsm_depth, texel, 0).r;
  if (depth <= 0.0) return none;
  float z = rsm_z_from_depth(view, depth);
  vec2 uv = (vec2(texel.xy) + 0.5) * (2.0 / float(resolution)) - 1.0;
  vec3 occluder = rsm_position_from_uvz(view, vec3(uv, z));
  vec3 occluder_normal = octahedral_decode(texelFetch(rsm_normal, texel, 0).rg);
  vec3 d = occluder - x.position;
  float range = view.directional != 0 ? view.depth_scale_m : z;
  float texel_m = rsm_texel_size_m(view, resolution, z);
  float error = texel_m / 256.0 + (range + length(x.position)) / 1048576.0 + length(d) * OCTAHEDRAL_ERROR_RAD;
  float above = dot(d, x.normal), in_front = dot(d - 16.0 * error * x.to_viewer, occluder_normal);
  none.beyond = above < -error;
  if (above <= -error || in_front <= error) return none;
  // Along the light the planes are in_front / cosine apart, and across it that changes by the difference of n / cosine.
  vec3 to_light = view.directional != 0 ? -view.forward : normalize(view.origin - x.position);
  float occluder_cosine = max(dot(occluder_normal, to_light), 1e-6);
  float slope = length(occluder_normal / occluder_cosine - x.normal / max(dot(x.normal, to_light), 1e-6));
  bool sharp = dot(occluder_normal, x.normal) < 0.5;
  float crease = sharp ? in_front / max(occluder_cosine * slope * texel_m, 1e-30) : NO_CREASE;
  return RsmOccluder(above > error, above <= error, false, crease);
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

// A point in the square of four texels is a diagonal at most from what one of them shows, and two from the next ones.
#define RSM_CONTACT_TEXELS 1.42
#define RSM_CONTACT_NEXT_TEXELS 2.83

// Whether one of the twelve texels around the four nearest hides the point, where the two surfaces meet: at a corner of what
// the light sees, all four may lie outside.
bool rsm_hidden_around(ReflectiveShadowLayer view, int resolution, ivec3 first, RsmReceiver x) {
  for (int k = 0; k < 16; ++k) {
    ivec2 step = ivec2(k & 3, k >> 2) - 1;
    if (all(equal(step & ~1, ivec2(0)))) continue;  // one of the four
    ivec2 texel = clamp(first.xy + step, ivec2(0), ivec2(resolution - 1));
    RsmOccluder o = rsm_occluder(view, resolution, ivec3(texel, first.z), x);
    if (o.hides && o.crease < RSM_CONTACT_NEXT_TEXELS) return true;
  }
  return false;
}

// Whether a texel beside one that lies at an edge hides the point, where the two surfaces meet. `away` leads from it.
bool rsm_hidden_beside(ReflectiveShadowLayer view, int resolution, ivec3 texel, ivec2 away, RsmReceiver x) {
  for (int k = 1; k < 4; ++k) {
    ivec2 next = clamp(texel.xy + away * ivec2(k & 1, k >> 1), ivec2(0), ivec2(resolution - 1));
    RsmOccluder o = rsm_occluder(view, resolution, ivec3(next, texel.z), x);
    if (o.hides && o.crease < RSM_CONTACT_NEXT_TEXELS) return true;
  }
  return false;
}

// Share of the light that reaches a point, between the four nearest texels, by band: glass colours it. Where a surface
// that hides it meets the receiver's own within a texel, texels beyond that edge have nothing to say: they would light
// the inner edges of a closed box.
vec3 rsm_visibility(int light, RsmReceiver x) {
  ReflectiveShadowLight l = rsm_lights[light];
  int layer = rsm_layer_of_direction(l.layer_count, x.position - l.light.position);
  ReflectiveShadowLayer view = rsm_layers[l.first_layer + layer];
  vec3 uvz = rsm_uvz_from_position(view, x.position);
  vec2 at = (uvz.xy * 0.5 + 0.5) * float(l.resolution) - 0.5;
  ivec2 first = ivec2(floor(at));
  vec2 t = at - vec2(first);
  vec3 visible = vec3(0.0);
  bool beyond = false;
  for (int k = 0; k < 4; ++k) {
    ivec2 corner = ivec2(k & 1, k >> 1);
    ivec3 texel = ivec3(clamp(first + corner, ivec2(0), ivec2(l.resolution - 1)), layer);
    vec2 w = mix(1.0 - t, t, vec2(corner));
    RsmOccluder o = rsm_occluder(view, l.resolution, texel, x);
    if (o.hides && o.crease < RSM_CONTACT_TEXELS) return vec3(0.0);
    if (o.at_edge && o.crease < RSM_CONTACT_TEXELS &&
        rsm_hidden_beside(view, l.resolution, texel, 2 * corner - 1, x))
      return vec3(0.0);
    if (!o.hides) visible += w.x * w.y * rsm_texel_tint(view, texel, uvz.z);
    beyond = beyond || o.beyond;
  }
  if (beyond && visible != vec3(0.0) && rsm_hidden_around(view, l.resolution, ivec3(first, layer), x)) return vec3(0.0);
  return visible;
}

#endif
