// Light that virtual lights send through a pixel's surface from behind: Cochran and Steele 2007, section 3.3.
#ifndef VOLGI_PASSED_LIGHT_GLSL
#define VOLGI_PASSED_LIGHT_GLSL
#include "shared/octahedral.glsl"
#include "shared/virtual_light.shared.h"

layout(binding = 0) uniform sampler2D position_map;
layout(binding = 1) uniform sampler2D normal_map;
layout(std430, binding = 0) readonly buffer Lights { VirtualLight lights[]; };
uniform int light_count;
uniform vec4 viewer;  // position and 1, or the direction towards an orthographic camera and 0
uniform vec3 view_axis;
uniform float pixel_m2;  // area of a pixel on the plane at distance 1; of an orthographic camera everywhere

struct PassedLight {
  vec3 irradiance;  // on the surface's back [W m^-2]
  vec3 direction;   // sum of directions that the light travels in, weighted by luminance
};

float luminance(vec3 c) { return dot(c, vec3(0.2126, 0.7152, 0.0722)); }

void add_passed_light(int light, vec3 position, vec3 normal, inout PassedLight sum) {
  VirtualLight l = lights[light];
  vec3 way = position - l.position;
  float squared = dot(way, way);
  // The cosine at the surface is the negated one: light arrives from behind.
  float cosines = max(dot(way, normal), 0.0) * max(dot(way, l.normal), 0.0);
  if (cosines <= 0.0) return;
  vec3 irradiance = l.flux * (cosines / (squared * (3.14159265358979 * squared + l.area_m2)));
  sum.irradiance += irradiance;
  sum.direction += luminance(irradiance) * way * inversesqrt(squared);
}

// Area of the surface in a pixel [m^2]; an oblique one counts as at 87 degrees at most, as virtual lights do.
float surface_m2_in_pixel(vec3 position, vec3 normal) {
  vec3 to_viewer = viewer.w == 0.0 ? viewer.xyz : viewer.xyz - position;
  float distance = length(to_viewer);
  float cosine = max(dot(to_viewer, normal) / distance, 0.05);
  if (viewer.w == 0.0) return pixel_m2 / cosine;
  float axis = abs(dot(to_viewer, view_axis)) / distance;
  return pixel_m2 * axis * axis * axis * distance * distance / cosine;
}

#endif
