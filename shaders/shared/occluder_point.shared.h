// A piece of surface as a point that stops light (core/occluder_points.h).
#ifndef VOLGI_OCCLUDER_POINT_SHARED_H
#define VOLGI_OCCLUDER_POINT_SHARED_H
#include "shared/base.shared.h"
SHARED_BEGIN

// std430, 32 bytes.
struct OccluderPoint {
  vec3 position;  // centred frame
  float area_m2;  // that the point stands for; 0: it stops nothing
  vec3 normal;    // unit, geometric
  float pad0;
};
#ifdef __cplusplus
static_assert(sizeof(OccluderPoint) == 32 && offsetof(OccluderPoint, normal) == 16);
#endif

SHARED_END
#endif
