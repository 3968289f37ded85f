// Beside what the G-buffer and the volume's sides bind.
#ifndef VOLGI_SKY_SLOTS_SHARED_H
#define VOLGI_SKY_SLOTS_SHARED_H
#include "shared/base.shared.h"
SHARED_BEGIN

#define SKY_PARTS_BLOCK 2
#define SKY_DEPTH_UNIT 12
#define SKY_NORMAL_UNIT 13
#define SKY_TINT_UNIT 14  // where there is glass
#define SKY_POINTS_SLOT 10
#define SKY_FLUX_SLOT 10
#define SKY_IRRADIANCE_IMAGE 0

#define SKY_MAX_PARTS 512  // in a uniform block of 48 KiB

// std140, 96 bytes: a part of the sky and its map, whose texel coordinates and depth are linear in position.
struct SkyPart {
  vec4 column;  // dot(column.xyz, position) + column.w, in texels
  vec4 row;
  vec4 way;         // along the light's way, unit; w: added to make a distance from the map's plane [m]
  vec4 one_column;  // a texel further [m]; w: distance that depth 1 ... 0 stands for [m]
  vec4 one_row;     // w: what a comparison may err at least [m]
  vec4 irradiance;  // on what faces it, nothing between [W m^-2]
};
#ifdef __cplusplus
static_assert(sizeof(SkyPart) == 96);
#endif

SHARED_END
#endif
