#version 450 core
// One level of the upsampling, coarsest to finest (Nichols 2010, §3.2.5): a texel that was rendered, or that a coarser
// one gives data to, is interpolated between the 3 x 3 around it that hold data; nothing comes from empty ones or goes
// there. What a coarser texel gives all four of its parts, the tent over 3 x 3 interpolates linearly. KEEP_RENDERED:
// what was rendered stays as it is, so that no light crosses an edge between pixels. TO_PIXELS: the last level, which
// ends in radiance.
#include "screen/base/gbuffer.glsl"
#include "screen/gather/subsplats/slots.shared.h"
#include "screen/gather/subsplats/subsplat.shared.h"
#include "shared/constants.glsl"
#include "shared/group_sizes.shared.h"
#include "shared/octahedral.glsl"

layout(local_size_x = SQUARE_GROUP, local_size_y = SQUARE_GROUP) in;
layout(binding = RENDERED_UNIT) uniform sampler2D rendered;  // irradiance in the flattened buffer; w = 0: none
layout(binding = COARSER_UNIT) uniform sampler2D coarser;    // what is upsampled, in the tower
layout(binding = UPSAMPLED_IMAGE, rgba32f) uniform writeonly image2D upsampled;
uniform ivec2 picture_size;
uniform int last_level;
#ifdef TO_PIXELS
const int level = 0;
uniform vec4 viewer;   // position and 1, or the direction towards an orthographic camera and 0
uniform float detail;  // alpha of eq. 3.3
#else
uniform int level;
#endif

vec4 rendered_at(ivec2 texel) {
  vec4 r = texelFetch(rendered, level_corner(picture_size, level) + texel, 0);
  return r.a > 0.0 ? vec4(max(r.rgb, 0.0), 1.0) : vec4(0.0);
}

// Of subsplats refined for each light alone, both: some lights' are coarser here.
vec4 data_at(ivec2 texel) {
  vec4 sum = rendered_at(texel);
  if (level < last_level) sum += texelFetch(coarser, tower_corner(picture_size, level + 1) + (texel >> 1), 0);
  return vec4(sum.rgb, min(sum.a, 1.0));
}

vec4 interpolated(ivec2 texel) {
  ivec2 end = level_size(picture_size, level);
  vec4 own = data_at(texel);
  if (own.a == 0.0) return vec4(0.0);
#ifdef KEEP_RENDERED
  if (rendered_at(texel).a > 0.0) return own;
#endif
  vec4 sum = vec4(0.0);
  for (int y = -1; y <= 1; ++y) {
    for (int x = -1; x <= 1; ++x) {
      ivec2 beside = texel + ivec2(x, y);
      if (any(lessThan(beside, ivec2(0))) || any(greaterThanEqual(beside, end))) continue;
      sum += float((2 - abs(x)) * (2 - abs(y))) * data_at(beside);  // w: 1 where there is data
    }
  }
  return vec4(sum.rgb / sum.a, 1.0);
}

#ifdef TO_PIXELS
// Irradiance to radiance, and eq. 3.3: detail of the surface that irradiance does not have, by how much it faces the
// viewer.
vec3 shaded(ivec2 pixel, vec3 irradiance) {
  vec4 position = texelFetch(position_map, pixel, 0);
  if (position.w == 0.0) return vec3(0.0);
  vec3 normal = octahedral_decode(texelFetch(normal_map, pixel, 0).xy);
  vec3 to_viewer = normalize(viewer.xyz - position.xyz * viewer.w);
  float modulation = detail * max(dot(to_viewer, normal), 0.0) + 1.0 - detail;
  return texelFetch(albedo_map, pixel, 0).rgb / PI * irradiance * modulation;
}
#endif

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(texel, level_size(picture_size, level)))) return;
  vec4 light = interpolated(texel);
#ifdef TO_PIXELS
  imageStore(upsampled, texel, vec4(shaded(texel, light.rgb), 1.0));
#else
  imageStore(upsampled, tower_corner(picture_size, level) + texel, light);
#endif
}
