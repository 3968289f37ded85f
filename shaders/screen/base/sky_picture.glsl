// The sky's picture as a direction sees it.
#ifndef VOLGI_SKY_PICTURE_GLSL
#define VOLGI_SKY_PICTURE_GLSL
#include "shared/constants.glsl"

// Latitude-longitude: row 0 is +Y, the middle column looks along -Z. CPU twin: Sky::radiance in core/sky.cpp.
vec2 sky_uv(vec3 d, float rotation_rad) {
  return vec2(0.5 + (atan(d.x, -d.z) - rotation_rad) / (2.0 * PI), acos(clamp(d.y, -1.0, 1.0)) / PI);
}

#endif
