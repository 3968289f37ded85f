#version 450 core
// Fast approximate anti-aliasing (screen/display/fxaa.h). Lottes' description, line by line; texels are fetched in
// place of his filtered look-ups between two of them, so that the picture's filter does not matter.
#include "screen/display/slots.shared.h"

layout(binding = FXAA_PICTURE_UNIT) uniform sampler2D picture;
layout(location = 0) out vec4 display;

const float LEAST_CONTRAST = 0.0625;          // below it in the dark, and
const float LEAST_RELATIVE_CONTRAST = 0.125;  // of the brightest of the five: left alone
const float SUBPIXEL = 0.75;                  // how much of what is thinner than a pixel is smoothed away
const int SEARCH_STEPS = 12;
const int SEARCH_STEP[SEARCH_STEPS] = int[](1, 1, 1, 1, 1, 1, 2, 2, 2, 4, 8, 8);  // pixels

vec3 color_at(ivec2 pixel) {
  return texelFetch(picture, clamp(pixel, ivec2(0), textureSize(picture, 0) - 1), 0).rgb;
}
float luma(vec3 color) { return dot(color, vec3(0.299, 0.587, 0.114)); }
float luma_at(ivec2 pixel) { return luma(color_at(pixel)); }

// Second differences along the columns: large where an edge lies along the rows.
float bend_across_rows(mat3 m) {
  return abs(m[0][0] + m[0][2] - 2.0 * m[0][1]) + 2.0 * abs(m[1][0] + m[1][2] - 2.0 * m[1][1]) +
         abs(m[2][0] + m[2][2] - 2.0 * m[2][1]);
}

// From `pixel` along an edge to its end: the distance in x, in y how the pair of pixels there differs from the pair here.
vec2 end_of_edge(ivec2 pixel, ivec2 along, ivec2 across, float mean, float end_contrast) {
  int distance = 0;
  float change = 0.0;
  for (int i = 0; i < SEARCH_STEPS && abs(change) < end_contrast; ++i) {
    distance += SEARCH_STEP[i];
    ivec2 at = pixel + distance * along;
    change = 0.5 * (luma_at(at) + luma_at(at + across)) - mean;
  }
  return vec2(distance, change);
}

// How far into the neighbour across the edge this pixel moves, so that the edge looks slanted. [pixels]
float offset_by_edge(ivec2 pixel, ivec2 along, ivec2 across, float middle, float neighbour) {
  float mean = 0.5 * (middle + neighbour);
  float end_contrast = 0.25 * abs(neighbour - middle);
  vec2 one = end_of_edge(pixel, along, across, mean, end_contrast);
  vec2 other = end_of_edge(pixel, -along, across, mean, end_contrast);
  vec2 nearest = one.x < other.x ? one : other;
  // An edge that ends on the other side of the mean turns towards the neighbour's row, and this one is not cut.
  bool cut = (nearest.y < 0.0) != (middle < mean);
  return cut ? 0.5 - nearest.x / (one.x + other.x) : 0.0;
}

// The same for what sticks out of its neighbours' mean.
float offset_by_contrast(mat3 m, float range) {
  float cross_sum = m[0][1] + m[2][1] + m[1][0] + m[1][2];
  float corners = m[0][0] + m[0][2] + m[2][0] + m[2][2];
  float apart = smoothstep(0.0, 1.0, abs((2.0 * cross_sum + corners) / 12.0 - m[1][1]) / range);
  return SUBPIXEL * apart * apart;
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec3 color = color_at(pixel);
  display = vec4(color, 1.0);
  // Lumas of 3 x 3 pixels, [column][row]; corners only where there is an edge.
  mat3 m = mat3(0.0);
  m[1][1] = luma(color);
  for (int side = -1; side <= 1; side += 2) {
    m[1 + side][1] = luma_at(pixel + ivec2(side, 0));
    m[1][1 + side] = luma_at(pixel + ivec2(0, side));
  }
  float brightest = max(m[1][1], max(max(m[0][1], m[2][1]), max(m[1][0], m[1][2])));
  float darkest = min(m[1][1], min(min(m[0][1], m[2][1]), min(m[1][0], m[1][2])));
  float range = brightest - darkest;
  if (range < max(LEAST_CONTRAST, LEAST_RELATIVE_CONTRAST * brightest)) return;
  for (int x = 0; x <= 2; x += 2) {
    for (int y = 0; y <= 2; y += 2) m[x][y] = luma_at(pixel + ivec2(x - 1, y - 1));
  }

  bool along_rows = bend_across_rows(m) >= bend_across_rows(transpose(m));
  ivec2 along = along_rows ? ivec2(1, 0) : ivec2(0, 1);
  float before = along_rows ? m[1][0] : m[0][1];
  float behind = along_rows ? m[1][2] : m[2][1];
  bool to_before = abs(before - m[1][1]) >= abs(behind - m[1][1]);
  ivec2 across = (to_before ? -1 : 1) * along.yx;
  float offset = max(offset_by_edge(pixel, along, across, m[1][1], to_before ? before : behind),
                     offset_by_contrast(m, range));
  display.rgb = mix(color, color_at(pixel + across), offset);
}
