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
#define MATERIAL_NORMAL_UNIT 3
#define DIRECTIONAL_ALBEDO_UNIT 4  // of what is drawn for the camera

// A surface's parts, glTF 2.0 appendix B: diffuse albedo before Fresnel takes its share, and what its mirror of facets
// reflects from in front and at grazing angles.
struct Reflectance {
  vec3 diffuse;
  vec3 at_0;
  float at_90;
};

// @param dielectric_0, dielectric_90  of the part that is no metal (KHR_materials_specular, _ior). @param lambertian
// nothing shines: 1, and metals are black.
SHARED_FUNCTION Reflectance reflectance_of(vec3 base, float metallic, vec3 dielectric_0, float dielectric_90,
                                           int lambertian) {
  Reflectance r;
  r.diffuse = base * (1.0f - metallic);
  float shines = lambertian != 0 ? 0.0f : 1.0f;
  r.at_0 = (dielectric_0 * (1.0f - metallic) + base * metallic) * shines;
  r.at_90 = (dielectric_90 * (1.0f - metallic) + metallic) * shines;
  return r;
}

// What a pane of glass does to light: `stops` of it meets a surface of the colour base * reflects, the rest goes
// straight on, times `tint`. base.a * base.rgb of the light passes, where it has no colour in the mean.
struct Pane {
  float stops;
  float reflects;
  vec3 tint;
};

// @param base  AlphaMode::glass: baseColor * COLOR_0, and the share that is not reflected. @param tinted  0 where light
// has no colour on its way: its luminance then decides how much passes, and the tint is 1.
SHARED_FUNCTION Pane pane_of(vec4 base, int tinted) {
  vec3 color = min(max(vec3(base.x, base.y, base.z), vec3(0.0f)), vec3(1.0f));
  float share = min(max(base.w, 0.0f), 1.0f);
  Pane pane;
  pane.stops = 1.0f - share;
  pane.reflects = 1.0f;
  pane.tint = color;
  if (tinted == 0) {
    pane.stops = 1.0f - share * (0.2126f * color.x + 0.7152f * color.y + 0.0722f * color.z);
    pane.reflects = pane.stops > 0.0f ? (1.0f - share) / pane.stops : 0.0f;
    pane.tint = vec3(1.0f);
  }
  return pane;
}

// Exponent of the Phong lobe (R.l)^n that is about as wide as GGX of a perceptual roughness: a facet turned by an angle
// turns its mirror's direction by twice that, so cos^(4 n) of facets is cos^n of directions, and GGX's alpha^2 is
// 2 / (4 n + 2).
SHARED_FUNCTION float phong_exponent(float roughness) {
  float alpha = roughness * roughness;
  return max(0.5f / max(alpha * alpha, 1e-6f) - 0.5f, 0.0f);
}

// Mean of Schlick's (1 - v.h)^5 over a Lambertian surface's directions of light and view.
#define SCHLICK_OF_DIFFUSE 0.0036868f

// What the mirror reflects in all, lit evenly from everywhere: linear in both reflectances. Polynomials of the
// perceptual roughness within 0.002 of an integral over visible normals (tests/core/metal_albedo_test.cpp). Single
// scattering, as glTF's: a rough white metal keeps 0.41.
SHARED_FUNCTION vec3 mirror_albedo(vec3 at_0, float at_90, float roughness) {
  float r = clamp(roughness, 0.0f, 1.0f);
  float of_0 = (((1.49687649f * r - 2.71710952f) * r + 0.72623374f) * r - 0.05095023f) * r + 0.95260215f;
  float of_90 = (((-0.21850646f * r + 0.54405833f) * r - 0.41000498f) * r + 0.03986327f) * r + 0.04710394f;
  return at_0 * of_0 + vec3(of_90 * at_90);
}

// Diffuse albedo of everything that a surface reflects: its mirror is spread over the hemisphere, so that no metal is
// black where light only passes.
SHARED_FUNCTION vec3 surface_albedo(Reflectance r, float roughness) {
  vec3 albedo = r.diffuse;
  if (r.at_90 > 0.0f) {
    float front = max(max(r.at_0.x, r.at_0.y), r.at_0.z);
    albedo *= 1.0f - (front + (r.at_90 - front) * SCHLICK_OF_DIFFUSE);
    albedo += mirror_albedo(r.at_0, r.at_90, roughness);
  }
  return min(max(albedo, vec3(0.0f)), vec3(1.0f));
}

SHARED_END

#endif
