// All virtual area lights, for gathers.
#ifndef VOLGI_AREA_LIGHTS_BLOCK_GLSL
#define VOLGI_AREA_LIGHTS_BLOCK_GLSL
#include "screen/visibility/area_maps/slots.shared.h"
#include "screen/visibility/area_maps/virtual_area_light.shared.h"

layout(std140, binding = AREA_LIGHTS_BLOCK) uniform AreaLights {
  VirtualAreaLight area_lights[MAX_VIRTUAL_AREA_LIGHTS];
};

#endif
