// Beside what the G-buffer and the volume's sides bind.
#ifndef VOLGI_SKY_SLOTS_SHARED_H
#define VOLGI_SKY_SLOTS_SHARED_H
#include "shared/base.shared.h"
SHARED_BEGIN

#define SKY_SURFACE_UNIT 12
#define SKY_TINT_UNIT 14   // where there is glass
#define SKY_PARTS_UNIT 15  // a buffer of SkyPart: software rasterizers read texels faster than uniform arrays
#define SKY_POINTS_SLOT 10
#define SKY_FLUX_SLOT 10
#define SKY_IRRADIANCE_IMAGE 0

#define SKY_MAX_PARTS 512

#define SKY_PART_TEXELS 4
// A part of the sky and its map, whose texel coordinates and depth are linear in position: four RGBA32F texels.
struct SkyPart {
  vec4 column;  // dot(column.xyz, position) + column.w, in texels
  vec4 row;
  vec4 way;    // the light's, unit; w: added to make a distance from the map's plane [m]
  vec4 light;  // irradiance on what faces it, nothing between [W m^-2]; w: distance that depth 1 ... 0 stands for [m]
};
#ifdef __cplusplus
static_assert(sizeof(SkyPart) == 16 * SKY_PART_TEXELS);
#endif

SHARED_END
#endif
