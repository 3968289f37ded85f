// Texture units of the G-buffer: GBuffer::bind() and screen/base/gbuffer.glsl.
#ifndef VOLGI_GBUFFER_SHARED_H
#define VOLGI_GBUFFER_SHARED_H

#define GBUFFER_POSITION_UNIT 0
#define GBUFFER_NORMALS_UNIT 1
#define GBUFFER_ALBEDO_UNIT 2
// Of surfaces that shine, for direct light alone: where no unit but these is taken.
#define GBUFFER_DIFFUSE_UNIT 3
#define GBUFFER_MIRROR_UNIT 4
#define GBUFFER_UNITS 3  // the first one that is free elsewhere

#endif
