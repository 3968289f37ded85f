// All virtual lights, and their order by clusters.
#ifndef VOLGI_LIGHT_ORDER_GLSL
#define VOLGI_LIGHT_ORDER_GLSL
#include "screen/base/virtual_lights.glsl"
#include "screen/visibility/area_maps/slots.shared.h"

layout(std430, binding = LIGHT_ORDER_SLOT) readonly buffer Order { uint order[]; };
layout(std430, binding = CLUSTER_OF_SLOT) readonly buffer Clusters { uint cluster_of[]; };

#endif
