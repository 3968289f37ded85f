#version 450 core
// Views of the maps of virtual lights: one for each light that has a map, or two, ahead and back.
#include "screen/base/slots.shared.h"
#include "screen/visibility/imperfect/map_views.glsl"
#include "screen/visibility/imperfect/slots.shared.h"
#include "shared/global_index.shared.h"
#include "shared/group_sizes.shared.h"
#include "shared/virtual_light.shared.h"

layout(local_size_x = LINEAR_GROUP) in;
layout(std430, binding = VIRTUAL_LIGHTS_SLOT) readonly buffer Lights { VirtualLight virtual_lights[]; };
layout(std430, binding = MAP_VIEWS_SLOT) writeonly buffer Views { VirtualAreaLight views[]; };
uniform int lights;
uniform int mapped;
uniform int sides;

void main() {
  int i = int(global_index());
  if (i >= mapped * sides) return;
  VirtualLight light = virtual_lights[light_of_map(i / sides, lights, mapped)];
  VirtualAreaLight view = map_view(light.position, i % sides == 0 ? light.normal : -light.normal);
  view.light_count = any(greaterThan(light.flux, vec3(0.0))) ? 1 : 0;
  views[i] = view;
}
