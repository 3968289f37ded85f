// Lobes of revolution, for the papers' schemes (sh.shared.h; docs/theory.md#papers).
#include "propagation/lobes.glsl"
#include "shared/grid.shared.h"

// Of power 1 about the unit vector n, with the zonal coefficients 1, zonal_1, zonal_2.
Lobe lobe_about(vec3 n, float zonal_1, float zonal_2) {
  vec4 low = vec4(1.0, zonal_1 * sh_basis_1(n).yzw);
#if ORDER == 1
  return low;
#else
  return Lobe(low, zonal_2 * sh_basis_2(n), zonal_2 * sh_basis_22(n));
#endif
}
Lobe cosine_lobe(vec3 n) { return lobe_about(n, COSINE_ZONAL_1, COSINE_ZONAL_2); }
Lobe cone_lobe(vec3 n) { return lobe_about(n, CONE_ZONAL_1, CONE_ZONAL_2); }

// Integral of the lobe times a lobe about n, or (zonal coefficients 1) its intensity in direction n, both times 4 pi.
float along(Lobe lobe, Lobe about) {
#if ORDER == 1
  return dot(lobe, about);
#else
  return dot(lobe.low, about.low) + dot(lobe.mid, about.mid) + lobe.high * about.high;
#endif
}
vec3 along(Lobes lobes, Lobe about) {
  return vec3(along(lobes.red, about), along(lobes.green, about), along(lobes.blue, about));
}

vec3 direction_of_face(int face) { return vec3(face_step(face)); }

// Powers that leave in the six directions along axes, by face.
Lobes cosine_lobes(vec3 power[6]) {
  Lobes sum = dark_lobes();
  for (int face = 0; face < 6; ++face) add_lobes(sum, power[face], cosine_lobe(direction_of_face(face)));
  return sum;
}
Lobes cone_lobes(vec3 power[6]) {
  Lobes sum = dark_lobes();
  for (int face = 0; face < 6; ++face) add_lobes(sum, power[face], cone_lobe(direction_of_face(face)));
  return sum;
}
