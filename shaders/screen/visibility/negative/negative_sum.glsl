// What negative lights take away at a point, behind screen/visibility/negative/negative_lights_block.glsl.
#ifndef VOLGI_NEGATIVE_SUM_GLSL
#define VOLGI_NEGATIVE_SUM_GLSL
#include "shared/constants.glsl"

vec3 sum_of_negative_lights(vec3 x, vec3 normal, int count) {
  vec3 sum = vec3(0.0);
  for (int i = 0; i < count; ++i) {
    vec3 w = negative_lights[i].position - x;
    float squared = max(dot(w, w), 1e-30);
    w *= inversesqrt(squared);
    float cosine = max(-dot(w, negative_lights[i].direction), 0.0);
    // The lobe widens by the angle that the light's own surface fills: variances 1 / e and A / (4 pi d^2) add.
    float e = negative_lights[i].exponent;
    e = max(e / (1.0 + e * negative_lights[i].area_m2 / (4.0 * PI * squared)), 1.0);
    float lobe = 0.5 * (e + 1.0) * (e == 1.0 ? cosine : pow(cosine, e));
    sum += negative_lights[i].flux * (lobe * max(dot(w, normal), 0.0) / (PI * squared + negative_lights[i].area_m2));
  }
  return sum;
}

#endif
