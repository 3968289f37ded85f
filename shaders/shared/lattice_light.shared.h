// A light of the wave lattice: it hangs in the air, and sends half as much back as ahead (wave-vpl-lattice excerpt,
// section 4.2).
#ifndef VOLGI_LATTICE_LIGHT_SHARED_H
#define VOLGI_LATTICE_LIGHT_SHARED_H
#include "shared/base.shared.h"
SHARED_BEGIN

// Irradiance over the light's flux [m^-2]. Its radiant intensity is I in front of it and I / 2 behind, so that its flux
// is 3 pi I; the distance is softened as a disk's on its axis is, by the part of its shell that it stands for.
// @param height   of the point over the light's plane, in front of it above 0 [m].
// @param along    of the light over the point's horizon, times its distance; above 0 [m].
// @param squared  distance [m^2].
SHARED_FUNCTION float lattice_light(float height, float along, float squared, float area_m2) {
  const float pi = 3.14159265f;
  float cosine = along / sqrt(max(squared, 1e-30f));
  return (height > 0.0f ? 1.0f : 0.5f) * cosine / (3.0f * (pi * squared + area_m2));
}

SHARED_END
#endif
