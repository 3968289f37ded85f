// What the bounces have come to: power that sides have received [W], and flux of the surfaces that are lit or shine.
#include "propagation/slots.shared.h"

layout(std430, binding = TOTAL_DIRECT_SLOT) readonly buffer TotalDirect { vec4 total_direct[]; };  // emission's arrival
layout(std430, binding = TOTAL_INDIRECT_SLOT) readonly buffer TotalIndirect { vec4 total_indirect[]; };  // all after
layout(std430, binding = EMITTED_FLUX_SLOT) readonly buffer EmittedFlux { vec4 emitted_flux[]; };
layout(std430, binding = PUNCTUAL_FLUX_SLOT) readonly buffer PunctualFlux { vec4 punctual_flux[]; };
