// A surface's mirror of facets, seen from one side: what it reflects, and directions through it.
// Set by the program: PHONG, where mirrors are Phong lobes
#ifndef VOLGI_LOBE_GLSL
#define VOLGI_LOBE_GLSL
#include "screen/base/visible_normals.glsl"
#include "shared/material.shared.h"

struct Lobe {
  vec3 normal, to_viewer;  // unit, away from the surface
  vec3 at_0;
  float at_90, alpha;
  float cos_viewer, lambda_viewer;
  vec3 mirrored;   // the viewer's direction
  float exponent;  // of a Phong lobe
};

// @param mirror  reflectance from in front, at grazing angles. @param roughness  perceptual.
Lobe lobe_of(vec3 normal, vec3 to_viewer, vec4 mirror, float roughness) {
  Lobe s;
  s.normal = normal;
  s.to_viewer = to_viewer;
  s.at_0 = mirror.rgb;
  s.at_90 = mirror.a;
  s.alpha = roughness * roughness;
  s.cos_viewer = max(dot(normal, to_viewer), 1e-4);
  s.lambda_viewer = smith_lambda(s.cos_viewer, s.alpha);
  s.mirrored = reflect(-to_viewer, normal);
  s.exponent = phong_exponent(roughness);
  return s;
}

vec3 fresnel(Lobe s, float cos_half) { return s.at_0 + (vec3(s.at_90) - s.at_0) * pow(1.0 - cos_half, 5.0); }

// Density of directions that the lobe itself chooses, by visible normals D G1 / (4 cos_viewer). [1/sr]
float lobe_density(Lobe s, vec3 l) {
#ifdef PHONG
  return (s.exponent + 1.0) / (2.0 * PI) * pow(clamp(dot(s.mirrored, l), 0.0, 1.0), s.exponent);
#else
  vec3 h = normalize(s.to_viewer + l);
  return ggx_distribution(max(dot(s.normal, h), 0.0), s.alpha) / ((1.0 + s.lambda_viewer) * 4.0 * s.cos_viewer);
#endif
}

// The reflectance distribution. [1/sr] @param cosine  of l, > 0.
vec3 lobe_reflectance(Lobe s, vec3 l, float cosine) {
#ifdef PHONG
  return s.at_0 * ((s.exponent + 2.0) / (2.0 * PI) * pow(clamp(dot(s.mirrored, l), 0.0, 1.0), s.exponent));
#else
  vec3 h = normalize(s.to_viewer + l);
  float distribution = ggx_distribution(max(dot(s.normal, h), 0.0), s.alpha);
  float masking = 1.0 / (1.0 + s.lambda_viewer + smith_lambda(cosine, s.alpha));
  return fresnel(s, clamp(dot(s.to_viewer, h), 0.0, 1.0)) * (distribution * masking / (4.0 * s.cos_viewer * cosine));
#endif
}

// A direction by that density. @param frame  frame_around(s.normal). @param xi  uniform in [0, 1)^2.
vec3 lobe_direction(Lobe s, mat3 frame, vec2 xi) {
#ifdef PHONG
  float z = pow(xi.x, 1.0 / (s.exponent + 1.0)), r = sqrt(max(1.0 - z * z, 0.0)), turn = 2.0 * PI * xi.y;
  return frame_around(s.mirrored) * vec3(r * cos(turn), r * sin(turn), z);
#else
  vec3 v = s.to_viewer * frame;
  v = normalize(vec3(v.xy, max(v.z, 1e-4)));
  return reflect(-s.to_viewer, frame * visible_normal(v, s.alpha, xi));
#endif
}

// Reflectance times cosine over density of such a direction. @param cosine  of l, > 0.
vec3 lobe_weight(Lobe s, vec3 l, float cosine) {
#ifdef PHONG
  return s.at_0 * (cosine * (s.exponent + 2.0) / (s.exponent + 1.0));
#else
  float both = (1.0 + s.lambda_viewer) / (1.0 + s.lambda_viewer + smith_lambda(cosine, s.alpha));
  return fresnel(s, clamp(dot(s.to_viewer, normalize(s.to_viewer + l)), 0.0, 1.0)) * both;
#endif
}

#endif
