#version 450 core
// Joins the subsets of lights that pixels of an interleaved block have gathered, along one axis. Dong et al. 2009,
// section 6, and Laine et al. 2007 take the mean over a window; we interpolate each subset, between the two pixels on
// either side that have it (a tent two blocks wide), which keeps what is linear. Pixels of other surfaces do not count;
// a subset with one pixel left is taken from there, and the mean goes over the subsets that are found. The second axis
// ends in radiance.
// Fourth channel and `error_estimate`: variance of the mean [luminance squared], judged by what varies. See below.
#include "shared/constants.glsl"
#include "screen/base/gbuffer.glsl"
#include "screen/gather/interleaved/slots.shared.h"
#include "shared/group_sizes.shared.h"
#include "shared/luminance.glsl"
#include "shared/octahedral.glsl"

layout(local_size_x = SQUARE_GROUP, local_size_y = SQUARE_GROUP) in;
// Fourth channel: the variance; read along the second axis only.
layout(binding = BLUR_SOURCE_UNIT) uniform sampler2D irradiance;
layout(binding = BLURRED_IMAGE, rgba32f) uniform writeonly image2D blurred;
layout(binding = BLUR_ERROR_IMAGE, r32f) uniform image2D error_estimate;  // radiance
uniform int interleave;
uniform ivec2 axis;
uniform float max_distance_m;
uniform float min_cosine;
uniform float off_plane;
uniform int ends;
uniform int adds;  // to the error estimate of another picture

struct Surface {
  vec3 position, normal;
};

// 1 where the pixel shows the same surface, 0 elsewhere.
float alike(Surface here, ivec2 at, ivec2 size) {
  ivec2 inside = clamp(at, ivec2(0), size - 1);
  vec4 there = texelFetch(position_map, inside, 0);
  vec3 way = there.xyz - here.position;
  float squared = dot(way, way);
  float height = dot(way, here.normal);
  float cosine = dot(octahedral_decode(texelFetch(normal_map, inside, 0).xy), here.normal);
  bool like = inside == at && there.w != 0.0 && squared <= max_distance_m * max_distance_m &&
              height * height <= off_plane * off_plane * squared && cosine >= min_cosine;
  return like ? 1.0 : 0.0;
}

// A subset varies between its two pixels, linearly at best. Where one is missing, or both, it is unknown by as much as
// those that are there vary, and as subsets differ from each other.
vec4 joined(ivec2 pixel, Surface here, ivec2 size) {
  float n = float(interleave);
  vec4 own = texelFetch(irradiance, pixel, 0);
  float bright = luminance(own.rgb);
  vec4 sum = own;                  // of the subsets, and of their variance along the other axis
  float square_sum = bright * bright;
  float found = 1.0, pairs = 0.0;  // subsets with a pixel, with two
  float variance = 0.0, differences = 0.0, way = 0.0;
  for (int i = 1; i < interleave; ++i) {
    ivec2 above = pixel + i * axis, below = pixel + (i - interleave) * axis;
    float w_above = alike(here, above, size) * (n - float(i)), w_below = alike(here, below, size) * float(i);
    float w = w_above + w_below;
    if (w == 0.0) continue;
    w_above /= w;
    w_below /= w;
    vec4 a = texelFetch(irradiance, clamp(above, ivec2(0), size - 1), 0);
    vec4 b = texelFetch(irradiance, clamp(below, ivec2(0), size - 1), 0);
    vec4 mean = w_above * a + w_below * b;
    float l = luminance(mean.rgb);
    float difference = luminance(a.rgb) - luminance(b.rgb);
    bool both = w_above > 0.0 && w_below > 0.0;
    sum += mean;
    square_sum += l * l;
    found += 1.0;
    pairs += both ? 1.0 : 0.0;
    differences += both ? difference * difference : 0.0;
    variance += w_above * w_below * difference * difference;
    float steps = w_above > 0.0 ? float(i) : n - float(i);
    way += both ? 0.0 : steps * steps / (n * n);
  }
  vec3 mean = sum.rgb / found;
  float spread = max(square_sum / found - luminance(mean) * luminance(mean), 0.0);
  float unknown = way * ((pairs > 0.0 ? differences / pairs : spread) + spread);
  variance = (variance + unknown) / (found * found) + spread * (n - found) / (n * found);
  return vec4(mean, variance + (ends != 0 ? sum.w / found : 0.0));
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  ivec2 size = textureSize(position_map, 0);
  if (any(greaterThanEqual(pixel, size))) return;
  vec4 position = texelFetch(position_map, pixel, 0);
  vec4 mean = vec4(0.0);
  float error = 0.0;
  if (position.w != 0.0) {
    mean = joined(pixel, Surface(position.xyz, octahedral_decode(texelFetch(normal_map, pixel, 0).xy)), size);
    if (ends != 0) {
      vec3 reflectance = texelFetch(albedo_map, pixel, 0).rgb / PI;
      mean.rgb *= reflectance;
      error = sqrt(mean.w) * luminance(reflectance);
      mean.w = 1.0;
    }
  }
  imageStore(blurred, pixel, mean);
  if (ends != 0) imageStore(error_estimate, pixel, vec4(error + (adds != 0 ? imageLoad(error_estimate, pixel).r : 0.0)));
}
