#version 450 core
// One virtual light for each of the equal parts of one light's cone, or of a sun's rectangle: samples of the host's
// (Halton's), or equal steps along Hilbert's curve (jittered, they were worse: room 14.1 % instead of 10.5 %).
#include "shared/global_index.shared.h"
#include "shared/group_sizes.shared.h"
#include "shared/hilbert.shared.h"
#include "screen/lights/rsm/virtual_light_sample.glsl"

layout(local_size_x = LINEAR_GROUP) in;
uniform float measure;    // of one part: solid angle [sr], of a sun area across the light [m^2]
uniform int along_curve;  // 1: along Hilbert's curve
uniform float in_step;    // where in each step along it, in [0, 1): the same for all, so that they stay equal

vec2 place_on_curve(int i) {
  return hilbert_point(uint(min((float(i) + in_step) / float(count), 0.99999994) * 4294967296.0));
}

void main() {
  int i = int(global_index());
  if (i >= count) return;
  ReflectiveShadowLight l = rsm_lights[light];
  VirtualLight made;
  if (along_curve != 0) made = sample_place(l, place_on_curve(i), measure);
  else if (l.light.type == LIGHT_DIRECTIONAL) made = sample_sun(l, samples[first_sample + i].xy, measure);
  else made = sample_cone(l, world_from_axis * samples[first_sample + i].xyz, measure);
  virtual_lights[first + i] = made;
}
