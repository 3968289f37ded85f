// What the passes of the wave lattice hand on, and where its shells are.
#ifndef VOLGI_LATTICE_SHARED_H
#define VOLGI_LATTICE_SHARED_H
#include "shared/base.shared.h"
SHARED_BEGIN
#ifdef __cplusplus
using glm::exp, glm::pow;
#endif

#define LATTICE_MAX_SHELLS 8
#define LATTICE_GROUPS 64  // that share out the texels of a shadow map
#define LATTICE_GROUP 64   // threads of each

// std430, 176 bytes. What one group has found in its texels; sums are in order, so they never differ.
struct LatticeSums {
  vec4 reflected[LATTICE_MAX_SHELLS];  // flux met between a shell and the next, times albedo [W]
  vec4 sent;                           // flux of the light in all directions [W]
  vec4 met;                            // what of it meets a surface [W]
  float farthest_m;                    // surface, from the light
  float pad0, pad1, pad2;
};
#ifdef __cplusplus
static_assert(sizeof(LatticeSums) == 16 * LATTICE_MAX_SHELLS + 48 && offsetof(LatticeSums, sent) == 128);
#endif

// Distance of a shell over the scene's depth: the last one's, and each before it `growth` times nearer.
SHARED_FUNCTION float lattice_shell(int shell, int shells, float farthest, float growth) {
  return farthest * pow(growth, float(shell - (shells - 1)));
}

// What is left of a light's power on the way, printed: exponential in the distance over the scene's depth.
SHARED_FUNCTION float lattice_attenuation(float shell, float attenuation) { return exp(-attenuation * shell); }

// Angles of a ray of the lattice: `along` from the axis, 0 to pi, and `about` it. Ray 0 runs along the axis; then come
// circles of `about_count` rays, `step` apart; rays of a sphere end with the one that runs backwards.
SHARED_FUNCTION vec2 lattice_angles(int ray, int about_count, float step) {
  const float pi = 3.14159265f;
  if (ray == 0) return vec2(0.0f, 0.0f);
  int circle = (ray - 1) / about_count;
  int place = ray - 1 - circle * about_count;
  return vec2(min(float(circle + 1) * step, pi), float(place) * (2.0f * pi / float(about_count)));
}

SHARED_END
#endif
