#version 450 core
// As slice.frag.glsl, but a fragment finds the crossings of all three families of lines that lie in its column.
#define FAMILIES 3
#include "voxel/keys.glsl"
#include "voxel/visit_faces.glsl"
#ifdef WRITE_SURFACES
#include "voxel/write_surfaces.glsl"
#else
#include "voxel/mark.glsl"
#endif

void main() { visit_three_families(); }
