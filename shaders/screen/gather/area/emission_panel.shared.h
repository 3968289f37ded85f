// An emissive parallelogram, whose picture is a layer's middle half; the rest of the layer is black, so that smaller
// pictures of it fade at its edges.
#ifndef VOLGI_EMISSION_PANEL_SHARED_H
#define VOLGI_EMISSION_PANEL_SHARED_H
#include "shared/base.shared.h"
SHARED_BEGIN

#define PANEL_TEXELS 128  // on an edge of the parallelogram
#define PANELS_MOST 8

// std430, 64 bytes.
struct EmissionPanel {
  vec3 corner;  // centred frame
  float area_m2;
  vec3 u_per_m;  // u of a point x of its plane is dot(x - corner, u_per_m), in [0, 1]
  float pad_u;
  vec3 v_per_m;
  float pad_v;
  vec3 normal;  // unit, on the side that the light leaves
  float pad_n;
};
#ifdef __cplusplus
static_assert(sizeof(EmissionPanel) == 64 && offsetof(EmissionPanel, normal) == 48);
#endif

SHARED_END
#endif
