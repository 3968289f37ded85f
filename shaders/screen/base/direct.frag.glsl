#version 450 core
// Light of one punctual light that reaches the viewer after one reflection: albedo / pi * E * visibility. Lights are
// added by blending.
#include "shared/constants.glsl"
// Set by the program: SHINES, where some material is not Lambertian
#include "screen/base/brdf.glsl"
#include "screen/base/gbuffer.glsl"
#include "shared/reflective_shadow_map.glsl"

uniform int light;
#ifdef SHINES
layout(binding = GBUFFER_DIFFUSE_UNIT) uniform sampler2D diffuse_map;
layout(binding = GBUFFER_MIRROR_UNIT) uniform sampler2D mirror_map;
#endif
uniform vec4 viewer;  // position and 1, or the direction towards an orthographic camera and 0

layout(location = 0) out vec4 radiance;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 position = texelFetch(position_map, pixel, 0);
  if (position.w == 0.0) discard;
  vec4 normals = texelFetch(normal_map, pixel, 0);
  vec3 to_light;
  vec3 irradiance = perpendicular_irradiance(rsm_lights[light].light, position.xyz, to_light);
  float cosine = dot(octahedral_decode(normals.xy), to_light);
  vec3 geometric_normal = octahedral_decode(normals.zw);
  // The light must be on the side of the triangle that the viewer sees.
  if (cosine <= 0.0 || dot(geometric_normal, to_light) <= 0.0 || irradiance == vec3(0.0)) discard;
  vec3 to_viewer = normalize(viewer.xyz - position.xyz * viewer.w);
  vec3 visibility = rsm_visibility(light, RsmReceiver(position.xyz, geometric_normal, to_viewer));
#ifdef SHINES
  vec4 diffuse = texelFetch(diffuse_map, pixel, 0), mirror = texelFetch(mirror_map, pixel, 0);
  vec3 reflected = reflected_to_viewer(Shine(diffuse.rgb, mirror.rgb, mirror.a, diffuse.a), octahedral_decode(normals.xy),
                                       to_viewer, to_light);
  radiance = vec4(reflected * (visibility * irradiance), 1.0);
#else
  irradiance *= cosine * visibility;
  radiance = vec4(texelFetch(albedo_map, pixel, 0).rgb / PI * irradiance, 1.0);
#endif
}
