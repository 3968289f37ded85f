#version 450 core
// What rays would find where each light is: luminance of the radiosity that its sides emit [W m^-2], 0 where they would
// find nothing.
#include "screen/bounces/glossy/slots.shared.h"
#include "shared/global_index.shared.h"
#include "shared/group_sizes.shared.h"
#include "shared/luminance.glsl"
#include "shared/virtual_light.shared.h"
#include "voxel/find_side.glsl"

layout(local_size_x = LINEAR_GROUP) in;
layout(std430, binding = GLOSSY_LIGHTS_SLOT) readonly buffer AreaLights { VirtualLight area_lights[]; };
layout(std430, binding = GLOSSY_LIGHT_SIDES_SLOT) writeonly buffer LightSides { float emitted_there[]; };
uniform int light_count;

void main() {
  int k = int(global_index());
  if (k >= light_count) return;
  ivec3 targets;
  vec3 weights, emitted = vec3(0.0);
  sides_of_point(area_lights[k].position, area_lights[k].normal, -1, targets, weights);
  for (int axis = 0; axis < 3; ++axis) {
    if (weights[axis] > 0.0) emitted += weights[axis] * sides[targets[axis]].radiosity;
  }
  emitted_there[k] = luminance(emitted);
}
