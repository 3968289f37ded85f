// Irradiance of a virtual light at a subsplat, over its flux [m^-2].
#ifndef VOLGI_SUBSPLAT_LIGHT_GLSL
#define VOLGI_SUBSPLAT_LIGHT_GLSL
#include "screen/gather/subsplats/subsplat_receiver.glsl"
#include "shared/constants.glsl"
#include "shared/disk_to_point.shared.h"
#include "shared/virtual_light.shared.h"

// Nichols 2010, eq. 4.1, the disk-to-point form as printed. FORM_POINT: eq. 3.2, whose distance is kept from getting
// smaller than the disk; FORM_EXACT: shared/disk_to_point.shared.h.
float light_form(vec3 position, vec3 normal, float area_m2, Receiver at) {
  vec3 w = position - at.position;
  float squared = dot(w, w), along = dot(w, at.normal), height = -dot(w, normal);
  if (min(min(along, dot(w, at.geometric)), height) <= 0.0) return 0.0;
#if defined(FORM_EXACT)
  return disk_to_point(height, along, -dot(normal, at.normal), squared, area_m2);
#else
  float cosines = along * height / max(squared, 1e-30);
#if defined(FORM_POINT)
  return cosines / max(PI * squared, area_m2 + 1e-30);
#else
  return cosines / (PI * squared + area_m2);
#endif
#endif
}

#endif
