// Material at a point of the triangle that a fragment stands for. Mipmap level: one for the whole triangle, in which a
// square of FOOTPRINT cells has one texel in the mean (0 magnifies), so that passes along different axes agree.
flat in ivec3 v_vertex[3];  // slice_vertex
flat in vec2 v_uv0[3];
flat in vec2 v_uv1[3];
flat in vec4 v_color[3];
flat in vec3 v_normal;  // zero for a triangle that had no area before its vertices were rounded
flat in uint v_triangle;
flat in int v_axis;

float triangle_lod(sampler2D image, int texcoord, mat3 transform);
#define MATERIAL_LOD triangle_lod(image, texcoord, transform)
#include "shared/material.glsl"

#ifndef FOOTPRINT
uniform float footprint;  // cells
#define FOOTPRINT footprint
#endif

float triangle_lod(sampler2D image, int texcoord, mat3 transform) {
  vec2 u = texcoord == 0 ? v_uv0[1] - v_uv0[0] : v_uv1[1] - v_uv1[0];
  vec2 v = texcoord == 0 ? v_uv0[2] - v_uv0[0] : v_uv1[2] - v_uv1[0];
  vec2 size = vec2(textureSize(image, 0));
  float texels = abs((u.x * v.y - u.y * v.x) * determinant(mat2(transform))) * size.x * size.y;
  vec3 a = vec3(v_vertex[1] - v_vertex[0]) / float(SLICE_STEPS);
  vec3 b = vec3(v_vertex[2] - v_vertex[0]) / float(SLICE_STEPS);
  return 0.5 * log2(max(texels * FOOTPRINT * FOOTPRINT / max(length(cross(a, b)), 1e-20), 1.0));
}

vec2 uv0_at(vec3 weights) { return weights.x * v_uv0[0] + weights.y * v_uv0[1] + weights.z * v_uv0[2]; }
vec2 uv1_at(vec3 weights) { return weights.x * v_uv1[0] + weights.y * v_uv1[1] + weights.z * v_uv1[2]; }
vec4 albedo_alpha_at(vec3 weights) {
  vec4 color = weights.x * v_color[0] + weights.y * v_color[1] + weights.z * v_color[2];
  return material_albedo_alpha(uv0_at(weights), uv1_at(weights), color);
}
// Share of light that the surface stops there. Scenes without cut-outs and glass are compiled without it.
float stopped_at(vec3 weights) {
#ifdef ALPHA
  return material_coverage(albedo_alpha_at(weights).a);
#else
  return 1.0;
#endif
}
