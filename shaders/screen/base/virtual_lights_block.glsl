// One block of the virtual lights, for gathers: uniform, as all threads read the same.
#ifndef VOLGI_VIRTUAL_LIGHTS_BLOCK_GLSL
#define VOLGI_VIRTUAL_LIGHTS_BLOCK_GLSL
#include "screen/base/slots.shared.h"
#include "shared/virtual_light.shared.h"

layout(std140, binding = VIRTUAL_LIGHTS_BLOCK) uniform Lights { VirtualLight lights[VIRTUAL_LIGHTS_PER_BLOCK]; };

#endif
