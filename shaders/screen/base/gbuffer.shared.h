// Texture units of the G-buffer: GBuffer::bind() and screen/base/gbuffer.glsl.
#ifndef VOLGI_GBUFFER_SHARED_H
#define VOLGI_GBUFFER_SHARED_H

#define GBUFFER_POSITION_UNIT 0
#define GBUFFER_NORMALS_UNIT 1
#define GBUFFER_ALBEDO_UNIT 2
#define GBUFFER_UNITS 3  // the first one that is free

#endif
