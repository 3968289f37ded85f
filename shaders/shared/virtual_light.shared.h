// Virtual lights: small one-sided disks that stand for lit or emissive surface. docs/conventions.md#virtual-lights.
#ifndef VOLGI_VIRTUAL_LIGHT_SHARED_H
#define VOLGI_VIRTUAL_LIGHT_SHARED_H
#include "shared/base.shared.h"
SHARED_BEGIN

#define VIRTUAL_LIGHT_REFLECTED 0  // flux of a punctual light after its first reflection: indirect light
#define VIRTUAL_LIGHT_EMITTED 1    // flux of an emissive surface: its arrival is direct light
#define VIRTUAL_LIGHT_NEGATIVE 2   // to be subtracted: flux that a surface should have stopped
#define VIRTUAL_LIGHT_LATTICE 3    // in the air, in place of reflections: lattice_light.shared.h has what it sends

// Lights in one uniform block: the least GL_MAX_UNIFORM_BLOCK_SIZE is 16 KiB, but every 4.5 driver in use has 64 KiB.
#define VIRTUAL_LIGHTS_PER_BLOCK 1024

// std140 and std430, 48 bytes. Irradiance at x with unit normal n:
// flux * cos_x * cos_l / (pi d^2 + area), cos_x = n.w, cos_l = -normal.w, w from x to the light.
struct VirtualLight {
  vec3 position;  // centred frame
  float area_m2;  // of the surface that the light stands for
  vec3 normal;    // unit, geometric, on the side that the light leaves
  int kind;       // VIRTUAL_LIGHT_*
  vec3 flux;      // power leaving [W], >= 0; 0 where a sample met nothing
  int source;     // index of the punctual light, -1 for emissive surfaces
};
#ifdef __cplusplus
static_assert(sizeof(VirtualLight) == 48 && offsetof(VirtualLight, normal) == 16 && offsetof(VirtualLight, flux) == 32);
#endif

SHARED_END
#endif
