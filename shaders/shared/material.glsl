// A material as core/gl/scene_buffers.cpp binds it, and what a surface point is made of. CPU twin: core/surface.cpp.
// A shader without screen derivatives (compute) defines MATERIAL_LOD to the mipmap level that it wants.
#ifndef VOLGI_MATERIAL_GLSL
#define VOLGI_MATERIAL_GLSL
#include "shared/material.shared.h"

#define MATERIAL_OPAQUE 0
#define MATERIAL_MASK 1
#define MATERIAL_BLEND 2
#define MATERIAL_GLASS 3
// Defined where what passes glass is coloured by it: screen/base/glass.frag.glsl goes with such a pass.
#ifdef MATERIAL_TINTED
#define MATERIAL_PASSES_TINTED 1
#else
#define MATERIAL_PASSES_TINTED 0
#endif

uniform vec4 material_base_color_factor;
uniform float material_metallic_factor;
uniform float material_roughness_factor;
uniform vec3 material_dielectric_0;  // reflectances of what is no metal
uniform float material_dielectric_90;
uniform int material_lambertian;
uniform int material_unlit;         // seen as its colour, and reflects nothing
uniform float material_sample;      // of several pictures in one: where in [0, 1) this one draws what BLEND shows
uniform vec3 material_emissive_radiance;  // W m^-2 sr^-1
uniform int material_alpha_mode;
uniform float material_alpha_cutoff;
uniform int material_double_sided;  // emission on both sides

// Texture coordinate set 0 or 1, or -1 where the material has no such texture.
uniform int material_base_color_texcoord;
uniform int material_metallic_texcoord;
uniform int material_emissive_texcoord;
uniform mat3 material_base_color_transform;
uniform mat3 material_metallic_transform;
uniform mat3 material_emissive_transform;

// Linear light (core/mipmaps.h).
layout(binding = MATERIAL_BASE_COLOR_UNIT) uniform sampler2D material_base_color_texture;
layout(binding = MATERIAL_METALLIC_UNIT) uniform sampler2D material_metallic_texture;
layout(binding = MATERIAL_EMISSIVE_UNIT) uniform sampler2D material_emissive_texture;

vec4 material_fetch(sampler2D image, int texcoord, mat3 transform, vec2 uv0, vec2 uv1) {
  if (texcoord < 0) return vec4(1.0);
  vec2 uv = (transform * vec3(texcoord == 0 ? uv0 : uv1, 1.0)).xy;
#ifdef MATERIAL_LOD
  return textureLod(image, uv, MATERIAL_LOD);
#else
  return texture(image, uv);
#endif
}

// baseColor * COLOR_0, linear; alpha untested.
vec4 material_base_as_written(vec2 uv0, vec2 uv1, vec4 color) {
  if (material_alpha_mode == MATERIAL_GLASS) color.a = 1.0;
  return material_base_color_factor * color *
         material_fetch(material_base_color_texture, material_base_color_texcoord, material_base_color_transform, uv0,
                        uv1);
}

// Of glass, what it reflects of the light that it stops, and how much that is.
vec4 material_base(vec2 uv0, vec2 uv1, vec4 color) {
  vec4 base = material_base_as_written(uv0, uv1, color);
  if (material_alpha_mode != MATERIAL_GLASS) return base;
  Pane pane = pane_of(base, MATERIAL_PASSES_TINTED);
  return vec4(base.rgb * pane.reflects, pane.stops);
}

// What a point is made of. @return perceptual roughness.
float material_reflectance(vec3 base, vec2 uv0, vec2 uv1, out Reflectance reflectance) {
  vec4 texel = material_fetch(material_metallic_texture, material_metallic_texcoord, material_metallic_transform, uv0, uv1);
  float lit = material_unlit != 0 ? 0.0 : 1.0;
  reflectance = reflectance_of(base, material_metallic_factor * texel.b, material_dielectric_0, material_dielectric_90,
                               material_lambertian);
  reflectance.diffuse *= lit;
  reflectance.at_0 *= lit;
  reflectance.at_90 *= lit;
  return material_roughness_factor * texel.g;
}

// surface_albedo(), and the alpha of the texture, untested.
vec4 material_albedo_alpha(vec2 uv0, vec2 uv1, vec4 color) {
  vec4 base = material_base(uv0, uv1, color);
  Reflectance reflectance;
  float roughness = material_reflectance(base.rgb, uv0, uv1, reflectance);
  return vec4(surface_albedo(reflectance, roughness), base.a);
}

// Radiance that the front side sends (both sides where material_double_sided).
vec3 material_emission(vec2 uv0, vec2 uv1) {
  return material_emissive_radiance * material_fetch(material_emissive_texture, material_emissive_texcoord,
                                                     material_emissive_transform, uv0, uv1).rgb;
}

// Share of light that the surface stops: 1 when opaque, 0 or 1 for MASK, alpha for BLEND and glass. For voxels.
float material_coverage(float alpha) {
  if (material_alpha_mode == MATERIAL_OPAQUE) return 1.0;
  if (material_alpha_mode == MATERIAL_MASK) return alpha + ALPHA_CUTOFF_SLACK >= material_alpha_cutoff ? 1.0 : 0.0;
  return clamp(alpha, 0.0, 1.0);
}

// PCG3D (Jarzynski and Olano 2020, "Hash functions for GPU rendering"), first component in [0, 1).
float material_hash(uvec3 v) {
  v = v * 1664525u + 1013904223u;
  v.x += v.y * v.z;
  v.y += v.z * v.x;
  v.z += v.x * v.y;
  v ^= v >> 16u;
  v.x += v.y * v.z;
  return float(v.x >> 8u) * (1.0 / 16777216.0);
}

// Whether a raster or shadow pass keeps the fragment. BLEND is kept with probability alpha, by a hash of `seed`: the
// pixel, and a number of the triangle so that surfaces behind one another decide independently. Pictures at even steps
// of material_sample keep it in alpha of them, exactly but for a step.
bool material_keeps(float alpha, uvec3 seed) {
  float coverage = material_coverage(alpha);
  return coverage >= 1.0 || fract(material_hash(seed) + material_sample) < coverage;
}

#endif
