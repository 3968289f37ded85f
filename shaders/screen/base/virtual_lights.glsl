// All virtual lights.
#ifndef VOLGI_VIRTUAL_LIGHTS_GLSL
#define VOLGI_VIRTUAL_LIGHTS_GLSL
#include "screen/base/slots.shared.h"
#include "shared/virtual_light.shared.h"

layout(std430, binding = VIRTUAL_LIGHTS_SLOT) readonly buffer Lights { VirtualLight lights[]; };

#endif
