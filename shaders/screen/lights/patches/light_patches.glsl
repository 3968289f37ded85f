// Patches of one light, where its maps are bound.
#ifndef VOLGI_LIGHT_PATCHES_GLSL
#define VOLGI_LIGHT_PATCHES_GLSL
#include "screen/lights/patches/light_patch.shared.h"
#include "screen/lights/patches/slots.shared.h"
#include "shared/constants.glsl"
#include "shared/global_index.shared.h"
#include "shared/luminance.glsl"
#include "shared/reflective_shadow_map.glsl"

layout(std430, binding = PATCHES_SLOT) buffer Patches { LightPatch patches[]; };
layout(std430, binding = PATCH_RANGES_SLOT) buffer Ranges { PatchRange ranges[]; };
uniform int light;
uniform int root_count;  // of all lights
uniform int first_root;  // of this one
uniform int grid;        // roots on a side of a layer
uniform int depth;
uniform float depth_threshold_m;
uniform float normal_threshold;
uniform int at_edges;  // 1: patches of several surfaces give way to their parts from any distance

// A patch of this light: which layer, and which texels of it, without the margin that the cone does not fill.
struct Cell {
  int layer;
  ivec2 first, end;
};

Cell cell_of(int index) {
  int edge = grid << depth;
  ivec2 cell = morton_cell(index % (edge * edge));
  int inner = rsm_lights[light].resolution - 2 * RSM_MARGIN_TEXELS;
  return Cell(index / (edge * edge), RSM_MARGIN_TEXELS + cell * inner / edge,
              RSM_MARGIN_TEXELS + (cell + 1) * inner / edge);
}

int patches_of_light() { return rsm_lights[light].layer_count * (grid << depth) * (grid << depth); }

// Among the patches of all lights and depths.
int place_of(int index) {
  return first_of_depth(root_count, depth) + (first_root << (2 * depth)) + index;
}

// Solid angle of a layer without its margin [sr], over that of a patch (eq. 4.4: all alike); of a sun area.
float even_measure(ReflectiveShadowLayer view) {
  float inner = 1.0 - 2.0 * float(RSM_MARGIN_TEXELS) / float(rsm_lights[light].resolution);
  float x = view.extent_x * inner, y = view.extent_y * inner;
  float whole = view.directional != 0 ? 4.0 * x * y : 4.0 * atan(x * y / sqrt(1.0 + x * x + y * y));
  float edge = float(grid << depth);
  return whole / (edge * edge);
}

// What eq. 4.3 takes for the distance: 1 of a sun, whose measure is an area.
float squared_distance(ReflectiveShadowLayer view, vec3 position) {
  vec3 d = position - view.origin;
  return view.directional != 0 ? 1.0 : dot(d, d);
}

// Surface of a part of the light's measure: eq. 4.3 over the cosine, as docs/conventions.md#virtual-lights has it.
float surface_of(ReflectiveShadowLayer view, vec3 position, vec3 normal, float measure) {
  vec3 from_light = view.directional != 0 ? view.forward : position - view.origin;
  float cosine = -dot(from_light, normal) / max(length(from_light), 1e-30);
  return measure * squared_distance(view, position) / max(cosine, 0.05);
}

bool is_discontinuous(PatchRange range) {
  vec3 turn = range.most - range.least;
  return range.nearest < PATCH_BACKGROUND &&
         (range.farthest - range.nearest > depth_threshold_m || max(turn.x, max(turn.y, turn.z)) > normal_threshold);
}

#define FROM_ANY_DISTANCE_M2 1e30

// bound_m2 of a patch whose largest texel, or part, has `bound_m2`.
float bound_of(PatchRange range, float bound_m2) {
  return at_edges != 0 && is_discontinuous(range) ? FROM_ANY_DISTANCE_M2 : min(bound_m2, FROM_ANY_DISTANCE_M2);
}

#if defined(SAMPLED)
// What its middle texel shows stands for all of it. EXACT: by its own solid angle and the cosine, else all solid angles
// alike and no cosine (eqs. 4.2 to 4.4).
void set_light(int index, inout LightPatch made) {
  Cell cell = cell_of(index);
  ReflectiveShadowLight l = rsm_lights[light];
  ReflectiveShadowLayer view = rsm_layers[l.first_layer + cell.layer];
  ivec2 texel = (cell.first + cell.end) / 2;
  made.normal = made.flux = vec3(0.0);
  made.area_m2 = 0.0;
  made.position = view.origin;
  vec3 arriving, albedo;
  if (!rsm_texel(light, cell.layer, texel, made.position, made.normal, arriving, albedo)) return;
  vec2 uv = (vec2(texel) + 0.5) * (2.0 / float(l.resolution)) - 1.0;
  vec3 radiant = arriving / rsm_texel_measure(view, l.resolution, uv.x, uv.y);
#ifdef EXACT
  float measure = made.measure;
  made.area_m2 = surface_of(view, made.position, made.normal, measure);
#else
  float measure = even_measure(view);
  made.area_m2 = measure * squared_distance(view, made.position);
#endif
  made.flux = radiant * measure * albedo;
}
#endif

#endif
