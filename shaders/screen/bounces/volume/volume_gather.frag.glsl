#version 450 core
// The volume's light on every pixel.
#include "screen/bounces/volume/volume_gather.glsl"
#include "shared/constants.glsl"

layout(location = 0) out vec4 direct_radiance;    // first arrival of emission, reflected to the viewer
layout(location = 1) out vec4 indirect_radiance;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 position = texelFetch(position_map, pixel, 0);
  direct_radiance = vec4(0.0);
  indirect_radiance = vec4(0.0);
  if (position.w == 0.0) return;
  Gathered g = gather_pixel(position.xyz, octahedral_decode(texelFetch(normal_map, pixel, 0).zw));  // geometric
  if (g.weight == 0.0) return;
  vec3 reflectance = texelFetch(albedo_map, pixel, 0).rgb / PI;
  direct_radiance = vec4(reflectance * g.direct / g.weight, 1.0);
  indirect_radiance = vec4(reflectance * g.indirect / g.weight, 1.0);
}
