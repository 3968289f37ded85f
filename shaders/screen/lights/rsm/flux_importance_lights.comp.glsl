#version 450 core
// Virtual lights of equal luminance: Halton points of the unit square, warped from block to block of the pyramid until
// they lie as densely as the texels reflect light (Clarberg et al. 2005, hierarchical sample warping, in blocks of 4 x
// 4). Layers lie side by side along x.
#include "screen/lights/rsm/slots.shared.h"
#include "shared/global_index.shared.h"
#include "screen/lights/rsm/virtual_light_at.glsl"
#include "screen/lights/rsm/flux_importance.glsl"
#include "shared/group_sizes.shared.h"

layout(local_size_x = LINEAR_GROUP) in;
layout(std430, binding = FLUX_PYRAMID_SLOT) readonly buffer Pyramid { float pyramid[]; };

// One of up to 6 weights in proportion; `at` in [0, 1) chooses, and is stretched over what it chose. A weight of 0 is
// never chosen unless all are.
int choose(float weights[6], int choices, inout float at) {
  float total = 0.0;
  for (int k = 0; k < choices; ++k) total += weights[k];
  float below = 0.0;
  int chosen = 0;
  float chosen_below = 0.0;
  for (int k = 0; k < choices; ++k) {
    if (weights[k] > 0.0 && (below <= at * total || weights[chosen] <= 0.0)) {
      chosen = k;
      chosen_below = below;
    }
    below += weights[k];
  }
  at = weights[chosen] > 0.0 ? clamp((at * total - chosen_below) / weights[chosen], 0.0, 0.9999999) : 0.5;
  return chosen;
}

// One of 4 x 4 weights: the row first.
ivec2 choose_of_16(float weights[16], inout vec2 at) {
  float rows[6] = float[6](0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
  for (int k = 0; k < 16; ++k) rows[k >> 2] += weights[k];
  int row = choose(rows, 4, at.y);
  float columns[6] = float[6](0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
  for (int k = 0; k < 4; ++k) columns[k] = weights[4 * row + k];
  return ivec2(choose(columns, 4, at.x), row);
}

vec3 reflected_by(ReflectiveShadowLight l, int layer, ivec2 texel) {
  vec3 position, normal, arriving, albedo;
  if (max(texel.x, texel.y) >= l.resolution) return vec3(0.0);
  return rsm_texel(light, layer, texel, position, normal, arriving, albedo) ? arriving * albedo : vec3(0.0);
}

// Which layer; total is the light that all reflect.
int choose_layer(ReflectiveShadowLight l, inout float at, out float total) {
  int top = level_start(l.resolution, l.layer_count, last_level(l.resolution));
  float layers[6] = float[6](0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
  total = 0.0;
  for (int k = 0; k < l.layer_count; ++k) {
    layers[k] = pyramid[top + k];
    total += layers[k];
  }
  return choose(layers, l.layer_count, at);
}

ivec2 choose_texel(ReflectiveShadowLight l, int layer, inout vec2 at) {
  ivec2 block = ivec2(0);
  float weights[16];
  for (int level = last_level(l.resolution) - 1; level > 0; --level) {
    int size = level_size(l.resolution, level);
    int from = level_start(l.resolution, l.layer_count, level) + layer * size * size;
    for (int k = 0; k < 16; ++k) {
      ivec2 child = 4 * block + ivec2(k & 3, k >> 2);
      weights[k] = max(child.x, child.y) < size ? pyramid[from + child.y * size + child.x] : 0.0;
    }
    block = 4 * block + choose_of_16(weights, at);
  }
  for (int k = 0; k < 16; ++k) {
    weights[k] = luminance(reflected_by(l, layer, 4 * block + ivec2(k & 3, k >> 2)));
  }
  return 4 * block + choose_of_16(weights, at);
}

void main() {
  int i = int(global_index());
  if (i >= count) return;
  ReflectiveShadowLight l = rsm_lights[light];
  vec2 at = samples[first_sample + i].xy;
  float total;
  int layer = choose_layer(l, at.x, total);
  ReflectiveShadowLayer view = rsm_layers[l.first_layer + layer];
  ivec2 texel = choose_texel(l, layer, at);
  vec2 uv = (vec2(texel) + at) * (2.0 / float(l.resolution)) - 1.0;
  vec3 reflected = reflected_by(l, layer, texel);
  float weight = luminance(reflected);
  Meeting meeting;
  if (weight <= 0.0 || !meet(view, l.resolution, layer, uv, texel, meeting)) {
    virtual_lights[first + i] = no_light(view, uv);
    return;
  }
  float share = total / (float(count) * weight);  // of the texel, that this light stands for: 1 / (N p)
  vec2 middle = uv_of_middle(l.resolution, texel);
  float measure = share * rsm_texel_measure(view, l.resolution, middle.x, middle.y);
  virtual_lights[first + i] = VirtualLight(meeting.position, measure * area_of_measure(view, meeting), meeting.normal,
                                           VIRTUAL_LIGHT_REFLECTED, share * reflected, light);
}
