#ifndef VOLGI_LIGHTS_VIEW_GLSL
#define VOLGI_LIGHTS_VIEW_GLSL
#include "screen/views/slots.shared.h"

float mean_flux(vec3 flux) { return dot(flux, vec3(1.0 / 3.0)); }

#endif
