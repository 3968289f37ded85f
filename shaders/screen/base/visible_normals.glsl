// Facets of GGX as a viewer sees them. Heitz 2018, "Sampling the GGX Distribution of Visible Normals". Written apart
// from the reference's (reference/scattering.cpp).
#ifndef VOLGI_VISIBLE_NORMALS_GLSL
#define VOLGI_VISIBLE_NORMALS_GLSL
#include "shared/constants.glsl"

// Duff et al. 2017, "Building an Orthonormal Basis, Revisited".
mat3 frame_around(vec3 n) {
  float s = n.z >= 0.0 ? 1.0 : -1.0;
  float a = -1.0 / (s + n.z), b = n.x * n.y * a;
  return mat3(vec3(1.0 + s * n.x * n.x * a, s * b, -s * n.x), vec3(b, s + n.y * n.y * a, -n.y), n);
}

// @param v  unit, in the frame whose z is the surface's normal, z > 0. @return the facet's normal there.
vec3 visible_normal(vec3 v, float alpha, vec2 xi) {
  vec3 stretched = normalize(vec3(alpha * v.xy, v.z));
  float across = dot(stretched.xy, stretched.xy);
  vec3 t1 = across > 1e-12 ? vec3(-stretched.y, stretched.x, 0.0) * inversesqrt(across) : vec3(1.0, 0.0, 0.0);
  vec3 t2 = cross(stretched, t1);
  float r = sqrt(xi.x), phi = 2.0 * PI * xi.y;
  float x = r * cos(phi), s = 0.5 * (1.0 + stretched.z);
  float y = mix(sqrt(max(1.0 - x * x, 0.0)), r * sin(phi), s);
  vec3 h = x * t1 + y * t2 + sqrt(max(1.0 - x * x - y * y, 0.0)) * stretched;
  return normalize(vec3(alpha * h.xy, max(h.z, 1e-6)));
}

// Smith's Lambda of a direction with this cosine to the normal.
float smith_lambda(float cosine, float alpha) {
  float squared = max(cosine * cosine, 1e-8);
  return 0.5 * (sqrt(1.0 + alpha * alpha * max(1.0 - squared, 0.0) / squared) - 1.0);
}

float ggx_distribution(float cos_half, float alpha) {
  float a2 = alpha * alpha, d = cos_half * cos_half * (a2 - 1.0) + 1.0;
  return a2 / (PI * d * d);
}

#endif
