// Light of the sub-lights of virtual lights on what is near those (shared/near_light.shared.h). The including file
// defines SUBLIGHTS_SLOT, where their buffer is bound.
#ifndef VOLGI_SUBLIGHTS_GLSL
#define VOLGI_SUBLIGHTS_GLSL
#include "shared/disk_to_point.glsl"
#include "shared/near_light.shared.h"
#include "shared/octahedral.glsl"

layout(std430, binding = SUBLIGHTS_SLOT) readonly buffer SubLights { SubLight sublights[]; };

struct Receiver {
  vec3 position, normal, geometric;
};

// Irradiance from sub-light p; `form` as far_share() takes it.
vec3 irradiance_of(Receiver at, int p, out float form) {
  vec3 w = sublights[p].position - at.position;
  float squared = dot(w, w);
  form = disk_form(squared, sublights[p].area_m2);
  float cosines = max(dot(w, at.normal), 0.0) * max(-dot(w, octahedral_decode(unpackSnorm2x16(sublights[p].normal))), 0.0);
  cosines = dot(w, at.geometric) > 0.0 ? cosines : 0.0;
  return sublights[p].flux * (cosines * form / (squared * squared + 1e-30));
}

vec3 irradiance_of_coarse(Receiver at, int light, int coarse, float zone) {
  float form;
  int first = light * SUBLIGHTS_PER_LIGHT;
  vec3 whole = irradiance_of(at, first + coarse, form);
  float far = far_share(form, zone);
  if (far >= 1.0) return whole;
  vec3 sum = vec3(0.0);
  for (int k = 0; k < FINE_SUBLIGHTS / COARSE_SUBLIGHTS; ++k) {
    float unused_form;
    sum += irradiance_of(at, first + COARSE_SUBLIGHTS + coarse * (FINE_SUBLIGHTS / COARSE_SUBLIGHTS) + k, unused_form);
  }
  return mix(sum, whole, far);
}

vec3 irradiance_of_sublights(Receiver at, int light, float zone) {
  vec3 sum = vec3(0.0);
  for (int coarse = 0; coarse < COARSE_SUBLIGHTS; ++coarse) sum += irradiance_of_coarse(at, light, coarse, zone);
  return sum;
}

#endif
