// What a surface reflects of light from one direction to the viewer: glTF 2.0, appendix B. GGX, height-correlated Smith
// masking, Schlick's Fresnel; the diffuse part is weighed by what the mirror leaves. Written apart from the reference's
// (reference/scattering.cpp).
// Set by the program: PHONG, where mirrors are Phong lobes
#ifndef VOLGI_BRDF_GLSL
#define VOLGI_BRDF_GLSL
#include "shared/constants.glsl"
#include "shared/material.shared.h"

struct Shine {
  vec3 diffuse;
  vec3 at_0;
  float at_90;
  float roughness;  // perceptual
};

// @param n, v, l  unit, away from the surface. @return the distribution times the cosine of l.
vec3 reflected_to_viewer(Shine s, vec3 n, vec3 v, vec3 l) {
#ifdef PHONG
  float exponent = phong_exponent(s.roughness);
  float lobe = pow(clamp(dot(reflect(-v, n), l), 0.0, 1.0), exponent) * (exponent + 2.0) / (2.0 * PI);
  float kept = 1.0 - max(max(s.at_0.r, s.at_0.g), s.at_0.b);
  return (s.diffuse * (kept / PI) + s.at_0 * lobe) * max(dot(n, l), 0.0);
#else
  float nl = max(dot(n, l), 0.0), nv = max(dot(n, v), 1e-4);
  vec3 h = normalize(v + l);
  float nh = clamp(dot(n, h), 0.0, 1.0), vh = clamp(dot(v, h), 0.0, 1.0);
  float alpha = max(s.roughness * s.roughness, 1e-3), a2 = alpha * alpha;
  vec3 fresnel = s.at_0 + (vec3(s.at_90) - s.at_0) * pow(1.0 - vh, 5.0);
  float lobe = nh * nh * (a2 - 1.0) + 1.0;
  float distribution = a2 / (PI * lobe * lobe);
  float masking = 0.5 / (nl * sqrt(nv * nv * (1.0 - a2) + a2) + nv * sqrt(nl * nl * (1.0 - a2) + a2));
  float left = 1.0 - max(max(fresnel.r, fresnel.g), fresnel.b);
  return (s.diffuse * (left / PI) + fresnel * (distribution * masking)) * nl;
#endif
}

#endif
