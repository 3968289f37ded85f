#version 450 core
// Irradiance of one subset of the virtual lights, times the number of subsets, at every n-th pixel in both directions.
// Each light counts as far as its area light is visible: Dong et al. 2009, section 4; we take the disk-to-point form of
// conventions.md, "VPL".
#include "shared/octahedral.glsl"
#include "shared/virtual_area_light.shared.h"
#include "shared/virtual_light.shared.h"
#include "screen/area_light_shadow.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D position_map;
layout(binding = 1) uniform sampler2D normal_map;
layout(binding = 2) uniform sampler2D albedo_map;
layout(binding = 0, rgba32f) uniform image2D indirect;
layout(binding = 1, rgba32f) uniform image2D direct;
layout(std140, binding = 0) uniform Lights { VirtualLight lights[VIRTUAL_LIGHTS_A_BLOCK]; };
layout(std140, binding = 1) uniform AreaLights { VirtualAreaLight area_lights[VIRTUAL_AREA_LIGHTS_MOST]; };
uniform int light_count;  // in the block
uniform int interleave;
uniform ivec2 offset;  // of the pixels in their blocks
uniform int with_direct;
uniform int begins;

const float PI = 3.14159265358979;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy) * interleave + offset;
  if (any(greaterThanEqual(pixel, textureSize(position_map, 0)))) return;
  vec4 position = texelFetch(position_map, pixel, 0);
  vec3 reflected = vec3(0.0), emitted = vec3(0.0);
  if (position.w != 0.0) {
    vec4 normals = texelFetch(normal_map, pixel, 0);
    vec3 normal = octahedral_decode(normals.xy);
    vec3 geometric = octahedral_decode(normals.zw);
    int seen = -1;
    float visibility = 0.0;
    for (int i = 0; i < light_count; ++i) {
      if (lights[i].flux == vec3(0.0)) continue;
      if (lights[i].source != seen) {
        seen = lights[i].source;
        visibility = area_light_visibility(seen, area_lights[seen], position.xyz, geometric);
      }
      vec3 w = lights[i].position - position.xyz;
      float squared = dot(w, w);
      float cosines = max(dot(w, normal), 0.0) * max(-dot(w, lights[i].normal), 0.0);
      cosines = dot(w, geometric) > 0.0 ? cosines : 0.0;
      vec3 irradiance = lights[i].flux * (visibility * cosines / (squared * (PI * squared + lights[i].area_m2) + 1e-30));
      if (lights[i].kind == VIRTUAL_LIGHT_EMITTED) emitted += irradiance;
      else reflected += irradiance;
    }
    // Without a blur to come, the sum ends here.
    vec3 scale = interleave == 1 ? texelFetch(albedo_map, pixel, 0).rgb / PI : vec3(interleave * interleave);
    reflected *= scale;
    emitted *= scale;
  }
  if (begins == 0) reflected += imageLoad(indirect, pixel).rgb;
  imageStore(indirect, pixel, vec4(reflected, 1.0));
  if (with_direct == 0) return;
  if (begins == 0) emitted += imageLoad(direct, pixel).rgb;
  imageStore(direct, pixel, vec4(emitted, 1.0));
}
