// Irradiance of a small one-sided disk at a point: docs/conventions.md, "VPL"; Nichols 2010, eq. 4.1.
#ifndef VOLGI_DISK_TO_POINT_GLSL
#define VOLGI_DISK_TO_POINT_GLSL
#include "shared/constants.glsl"

// Over the disk's flux [m^-2].
// @param cosines  product of the cosines at both ends, each times the distance; other factors may be in it.
// @param squared  distance [m^2].
float disk_to_point(float cosines, float squared, float area_m2) {
  return cosines / (squared * (PI * squared + area_m2) + 1e-30);
}

// The form's part that does not depend on angles, times the squared distance: what far_share() takes.
float disk_form(float squared, float area_m2) { return squared / (PI * squared + area_m2 + 1e-30); }

#endif
