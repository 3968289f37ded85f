// Irradiance of all smooth light, PICTURES of it, as far as it is known.
#ifndef VOLGI_SMOOTH_PICTURES_GLSL
#define VOLGI_SMOOTH_PICTURES_GLSL
#include "screen/base/slots.shared.h"

#ifndef PICTURES  // screen/base/smooth_pixels.cpp says
#define PICTURES 1
#endif

layout(binding = SMOOTH_IRRADIANCE_UNIT) uniform sampler2D known[PICTURES];

#endif
