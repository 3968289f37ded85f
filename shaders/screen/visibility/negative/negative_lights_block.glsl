// All negative lights, for a gather.
#ifndef VOLGI_NEGATIVE_LIGHTS_BLOCK_GLSL
#define VOLGI_NEGATIVE_LIGHTS_BLOCK_GLSL
#include "screen/visibility/negative/negative_light.shared.h"
#include "screen/visibility/negative/slots.shared.h"

layout(std140, binding = NEGATIVE_LIGHTS_BLOCK) uniform NegativeLights {
  NegativeLight negative_lights[MAX_NEGATIVE_LIGHTS];
};

#endif
