// Light of the sub-lights of virtual lights on what is near those (shared/near_light.shared.h). SUBLIGHTS_BINDING: of their
// buffer.
#ifndef VOLGI_SUBLIGHTS_GLSL
#define VOLGI_SUBLIGHTS_GLSL
#include "shared/disk_to_point.shared.h"
#include "shared/near_light.shared.h"
#include "shared/octahedral.glsl"

layout(std430, binding = SUBLIGHTS_BINDING) readonly buffer SubLights { SubLight sublights[]; };

#ifdef FROM_AFAR  // `zone` is DISK_FAR_AREAS at least, so that coarse sub-lights are
#define COARSE_DISK_TO_POINT disk_to_point_from_afar
#else
#define COARSE_DISK_TO_POINT disk_to_point
#endif

struct Receiver {
  vec3 position, normal, geometric;
};

// One of them as a point sees it.
struct Disk {
  float height, along, facing, squared;  // disk_to_point()
  bool seen;
};

Disk disk_of(Receiver at, int p) {
  vec3 w = sublights[p].position - at.position;
  vec3 normal = octahedral_decode(unpackSnorm2x16(sublights[p].normal));
  float along = dot(w, at.normal);
  return Disk(max(-dot(w, normal), 0.0), along, -dot(normal, at.normal), dot(w, w), min(along, dot(w, at.geometric)) > 0.0);
}

vec3 irradiance_of_fine(Receiver at, int p) {
  Disk d = disk_of(at, p);
  return d.seen ? sublights[p].flux * disk_to_point(d.height, d.along, d.facing, d.squared, sublights[p].area_m2) : vec3(0.0);
}

vec3 irradiance_of_coarse(Receiver at, int light, int coarse, float zone) {
  int first = light * SUBLIGHTS_PER_LIGHT;
  int p = first + coarse;
  float area_m2 = sublights[p].area_m2;
  Disk d = disk_of(at, p);
  float far = far_share(disk_nearness(d.squared, area_m2), zone);
  float form = far > 0.0 && d.seen ? COARSE_DISK_TO_POINT(d.height, d.along, d.facing, d.squared, area_m2) : 0.0;
  vec3 whole = sublights[p].flux * form;
  if (far >= 1.0) return whole;
  vec3 sum = vec3(0.0);
  for (int k = 0; k < FINE_SUBLIGHTS / COARSE_SUBLIGHTS; ++k) {
    sum += irradiance_of_fine(at, first + COARSE_SUBLIGHTS + coarse * (FINE_SUBLIGHTS / COARSE_SUBLIGHTS) + k);
  }
  return mix(sum, whole, far);
}

vec3 irradiance_of_sublights(Receiver at, int light, float zone) {
  vec3 sum = vec3(0.0);
  for (int coarse = 0; coarse < COARSE_SUBLIGHTS; ++coarse) sum += irradiance_of_coarse(at, light, coarse, zone);
  return sum;
}

#endif
