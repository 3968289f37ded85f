// Convolution soft shadow maps: Annen et al. 2008, in the paraboloid form of Dong et al. 2009, section 4.
#include "screen/visibility/area_maps/convolution_basis.glsl"
#include "screen/visibility/area_maps/slots.shared.h"

layout(binding = SHADOW_BASIS_UNIT) uniform sampler2DArray shadow_basis;
layout(binding = SHADOW_BASIS_DEPTH_UNIT) uniform sampler2DArray shadow_basis_depth;
layout(binding = SHADOW_DEPTH_UNIT) uniform sampler2DArray shadow_depth;
layout(binding = SHADOW_FARTHEST_UNIT) uniform sampler2D shadow_farthest;

// Values of AREA_LIGHT_SHADOW_CONVOLUTION: AreaLightShadow::Filter.
#define FILTER_OF_MAP 0
#define FILTER_AS_PRINTED 1

// Sum over the series' terms for what a filtered texel holds: 2/pi sum (sin z cos d - cos z sin d) / (2k - 1).
float step_sum(sampler2DArray images, vec2 uv, int layer, float level, float d) {
  vec4 c = 2.0 * textureLod(images, vec3(uv, float(2 * layer)), level) - 1.0;
  vec4 s = 2.0 * textureLod(images, vec3(uv, float(2 * layer + 1)), level) - 1.0;
  vec4 angle = STEP_FREQUENCY * d;
  return 2.0 * dot(s * cos(angle) - c * sin(angle), 1.0 / STEP_FREQUENCY);
}

// Level of detail whose trilinear footprint has the variance of a square `width` of the map wide: a box of 2^level
// texels has 4^level / 12 along each axis, linear interpolation between boxes adds 4^level / 6 in the mean.
float level_of(float width, int resolution) { return max(log2(width * float(resolution) * 0.577350269), 0.0); }

// Receivers that slope within the filter would hide themselves: the reference is the nearest point of their plane
// there.
float reference_depth(ShadowReceiver receiver, float receiver_m, float farthest_m, float angle) {
  float cosine = abs(dot(receiver.position, receiver.normal)) / receiver_m;
  float tangent = sqrt(max(1.0 - cosine * cosine, 0.0)) / max(cosine, 1e-6);
  float nearest_m = receiver_m / (1.0 + 0.5 * angle * tangent);
  float d = STEP_RANGE * nearest_m / farthest_m - STEP_WIDTH;
  return clamp(d, -STEP_WIDTH, STEP_RANGE + STEP_WIDTH);
}

float receiver_visibility(VirtualAreaLight light, ShadowReceiver receiver) {
  int resolution = textureSize(shadow_basis, 0).x;
  float receiver_m = length(receiver.position);
  float farthest_m = texelFetch(shadow_farthest, ivec2(receiver.layer, 0), 0).r;
  vec2 disk = paraboloid_from_direction(receiver.position / receiver_m);
  vec2 uv = disk * 0.5 + 0.5;
  float texel = texel_angle(disk, resolution);
  // Of the map's whole width: the map's own scale here, or Dong's w = alpha/pi everywhere.
  const bool as_printed = AREA_LIGHT_SHADOW_CONVOLUTION == FILTER_AS_PRINTED;
  float width_per_angle = as_printed ? 1.0 / PI : 1.0 / (texel * float(resolution));

  // The first filter: the angle that the light is seen under.
  float angle = max(atan(light.size_m / receiver_m), texel);
  float d = reference_depth(receiver, receiver_m, farthest_m, angle);
  float level = level_of(angle * width_per_angle, resolution);
  float lit = 0.5 + step_sum(shadow_basis, uv, receiver.layer, level, d);
  float blocked = 1.0 - lit - STEP_LEAK;
  if (blocked <= STEP_ROUNDING) return 1.0;  // less says nothing of where blockers are
  float mean = textureLod(shadow_depth, vec3(uv, float(receiver.layer)), level).r;
  float lit_depth = 0.5 * mean + step_sum(shadow_basis_depth, uv, receiver.layer, level, d);
  float z = (mean * (1.0 - STEP_LEAK) - lit_depth) / blocked * farthest_m / STEP_RANGE;
  z = clamp(z, 1e-3 * receiver_m, receiver_m);

  // p cos(beta) = (d - z_avg) Delta / z_avg, alpha = arctan(p cos(beta) / d).
  angle = max(atan((receiver_m - z) * light.size_m / (z * receiver_m)), texel);
  d = reference_depth(receiver, receiver_m, farthest_m, angle);
  lit = 0.5 + step_sum(shadow_basis, uv, receiver.layer, level_of(angle * width_per_angle, resolution), d);
  return clamp((lit - STEP_LEAK) / (1.0 - 2.0 * STEP_LEAK), 0.0, 1.0);
}
