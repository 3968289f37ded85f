// Constants and texture units of materials: core/surface.cpp, gl::SceneBuffers and shared/material.glsl.
#ifndef VOLGI_MATERIAL_SHARED_H
#define VOLGI_MATERIAL_SHARED_H
#include "shared/base.shared.h"
SHARED_BEGIN

// Alpha at the cutoff is opaque (glTF 2.0, 3.9.4), also where interpolation has rounded it down.
#define ALPHA_CUTOFF_SLACK 1e-4f

#define MATERIAL_BASE_COLOR_UNIT 0
#define MATERIAL_METALLIC_UNIT 1
#define MATERIAL_EMISSIVE_UNIT 2

// What a metal reflects in all, lit evenly from everywhere: the mean directional albedo of glTF's conductor (appendix
// B: GGX, height-correlated Smith, Schlick with F0 = baseColor), which is linear in F0. Polynomials of the perceptual
// roughness within 0.002 of an integral over visible normals (tests/core/metal_albedo_test.cpp). Single scattering, as
// there: a rough white metal keeps 0.41.
SHARED_FUNCTION vec3 metal_albedo(vec3 base, float roughness) {
  float r = clamp(roughness, 0.0f, 1.0f);
  float of_base = (((1.49687649f * r - 2.71710952f) * r + 0.72623374f) * r - 0.05095023f) * r + 0.95260215f;
  float of_white = (((-0.21850646f * r + 0.54405833f) * r - 0.41000498f) * r + 0.03986327f) * r + 0.04710394f;
  return base * of_base + vec3(of_white);
}

// Diffuse albedo of everything that a surface reflects: a metal's mirror is spread over the hemisphere, so that it is
// not black.
SHARED_FUNCTION vec3 surface_albedo(vec3 base, float metallic, float roughness) {
  vec3 metal = metallic > 0.0f ? metal_albedo(base, roughness) : vec3(0.0f);
  vec3 albedo = base * (1.0f - metallic) + metal * metallic;
  return min(max(albedo, vec3(0.0f)), vec3(1.0f));
}

SHARED_END

#endif
