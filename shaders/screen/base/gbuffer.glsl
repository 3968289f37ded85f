// What the camera sees, as GBuffer::bind() has it; formats are described in screen/base/gbuffer.h.
#ifndef VOLGI_GBUFFER_GLSL
#define VOLGI_GBUFFER_GLSL
#include "screen/base/gbuffer.shared.h"

layout(binding = GBUFFER_POSITION_UNIT) uniform sampler2D position_map;
layout(binding = GBUFFER_NORMALS_UNIT) uniform sampler2D normal_map;
layout(binding = GBUFFER_ALBEDO_UNIT) uniform sampler2D albedo_map;

#endif
