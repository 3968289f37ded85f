// Light of the pieces of virtual lights on what is near those (shared/near_light.shared.h). LIGHT_PIECES_BINDING: of their
// buffer.
#ifndef VOLGI_LIGHT_PARTS_GLSL
#define VOLGI_LIGHT_PARTS_GLSL
#include "shared/disk_to_point.glsl"
#include "shared/near_light.shared.h"
#include "shared/octahedral.glsl"

layout(std430, binding = LIGHT_PIECES_BINDING) readonly buffer Pieces { SubLight pieces[]; };

struct Receiver {
  vec3 position, normal, geometric;
};

// Irradiance from sub-light p; `form` as far_share() takes it.
vec3 irradiance_of(Receiver at, int p, out float form) {
  vec3 w = pieces[p].position - at.position;
  float squared = dot(w, w);
  form = disk_form(squared, pieces[p].area_m2);
  float cosines = max(dot(w, at.normal), 0.0) * max(-dot(w, octahedral_decode(unpackSnorm2x16(pieces[p].normal))), 0.0);
  cosines = dot(w, at.geometric) > 0.0 ? cosines : 0.0;
  return pieces[p].flux * (cosines * form / (squared * squared + 1e-30));
}

vec3 irradiance_of_quarter(Receiver at, int light, int quarter, float zone) {
  float form;
  int first = light * SUBLIGHTS_PER_LIGHT;
  vec3 whole = irradiance_of(at, first + quarter, form);
  float far = far_share(form, zone);
  if (far >= 1.0) return whole;
  vec3 sum = vec3(0.0);
  for (int k = 0; k < FINE_SUBLIGHTS / COARSE_SUBLIGHTS; ++k) {
    float unused_form;
    sum += irradiance_of(at, first + COARSE_SUBLIGHTS + quarter * (FINE_SUBLIGHTS / COARSE_SUBLIGHTS) + k, unused_form);
  }
  return mix(sum, whole, far);
}

vec3 irradiance_of_parts(Receiver at, int light, float zone) {
  vec3 sum = vec3(0.0);
  for (int quarter = 0; quarter < COARSE_SUBLIGHTS; ++quarter) sum += irradiance_of_quarter(at, light, quarter, zone);
  return sum;
}

#endif
