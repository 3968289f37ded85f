// Which pixels stand for their neighbourhood, and how lists of the others are kept.
#ifndef VOLGI_COARSE_PIXELS_GLSL
#define VOLGI_COARSE_PIXELS_GLSL

uniform int stride;  // between coarse pixels; 1: every pixel

#include "screen/base/work_list.glsl"

// Coarse texels lie on every stride-th pixel, and on the last row and column, so that all pixels lie between some.
ivec2 pixel_of_coarse(ivec2 coarse, ivec2 size) { return min(coarse * stride, size - 1); }

uint pack_pixel(ivec2 pixel) { return uint(pixel.x) | uint(pixel.y) << 16; }
ivec2 unpack_pixel(uint packed_pixel) { return ivec2(packed_pixel & 0xffffu, packed_pixel >> 16); }

#endif
