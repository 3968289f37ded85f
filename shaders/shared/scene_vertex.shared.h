// The vertex buffer of core/gl/scene_buffers.cpp, for shaders that read it as storage: three vertices a triangle.
#ifndef VOLGI_SCENE_VERTEX_SHARED_H
#define VOLGI_SCENE_VERTEX_SHARED_H

#define VERTEX_FLOATS 18  // stride; the places of its members follow
#define VERTEX_POSITION 0
#define VERTEX_UV0 6
#define VERTEX_UV1 8
#define VERTEX_COLOR 10

#endif
