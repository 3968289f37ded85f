// Light that virtual lights send through a pixel's surface from behind: Cochran and Steele 2007, section 3.3.
#ifndef VOLGI_PASSED_LIGHT_GLSL
#define VOLGI_PASSED_LIGHT_GLSL
#include "shared/constants.glsl"
#include "screen/base/gbuffer.glsl"
#include "screen/base/virtual_lights.glsl"
#include "shared/luminance.glsl"
#include "shared/octahedral.glsl"

uniform int light_count;
uniform vec4 viewer;  // position and 1, or the direction towards an orthographic camera and 0
uniform vec3 view_axis;
uniform float pixel_m2;  // area of a pixel on the plane at distance 1; of an orthographic camera everywhere

// What lies in one plane with a light is not behind it, however normals and depths are rounded.
#define MIN_COSINE (4.0 * OCTAHEDRAL_ERROR_RAD)

struct PassedLight {
  vec3 irradiance;  // on the surface's back [W m^-2]
  vec3 direction;   // sum of directions that the light travels in, weighted by luminance
};

void add_passed_light(int light, vec3 position, vec3 normal, inout PassedLight sum) {
  VirtualLight l = lights[light];
  vec3 way = position - l.position;
  float squared = dot(way, way);
  float distance = sqrt(squared);
  // The cosine at the surface is the negated one: light arrives from behind.
  float cosine_here = dot(way, normal), cosine_there = dot(way, l.normal);
  if (min(cosine_here, cosine_there) <= MIN_COSINE * distance) return;
  // Nichols' form (2010, eq. 4.1), which falls to nothing towards the light's plane: the exact one would take light from
  // sides whose rounded depths put them just behind it.
  vec3 irradiance = l.flux * (cosine_here * cosine_there / (squared * (PI * squared + l.area_m2)));
  sum.irradiance += irradiance;
  sum.direction += luminance(irradiance) * way / distance;
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
