#version 450 core
// What each candidate sends to the receivers, without visibility: near enough by Nichols' form (2010, eq. 4.1).
#include "shared/constants.glsl"
#include "shared/global_index.shared.h"
#include "shared/group_sizes.shared.h"
#include "shared/luminance.glsl"
#include "screen/lights/resample/light_candidates.glsl"

layout(local_size_x = LINEAR_GROUP) in;

void main() {
  int i = int(global_index());
  if (i >= candidate_count) return;
  VirtualLight l = candidate_lights[first_candidate + i];
  float flux = luminance(l.flux);
  float sum = 0.0;
  if (flux > 0.0) {
    for (int k = 0; k < RESAMPLE_RECEIVERS; ++k) {
      vec3 w = l.position - receivers[k].position.xyz;
      float squared = dot(w, w);
      float cosines = max(dot(w, receivers[k].normal.xyz), 0.0) * max(-dot(w, l.normal), 0.0);
      sum += receivers[k].position.w * cosines / (squared * (PI * squared + l.area_m2) + 1e-30);
    }
  }
  weights[first_candidate + i] = vec2(flux * sum, flux);
}
