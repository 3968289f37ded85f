#version 450 core
// A fragment of slicing stands for the nine fine lines of a column (Gaitatzes 2010, Algorithm 1, three times finer). Where
// a line meets the triangle, it is blocked in the part that lies between two nodes. First run: mark; second run,
// WRITE_SURFACES: the nearest surfaces write what the cells see.
#include "voxel/keys.glsl"
#include "voxel/visit_faces.glsl"
#ifdef WRITE_SURFACES
#include "voxel/write_surfaces.glsl"
#else
#include "voxel/mark.glsl"
#endif

uniform int axis;

void main() { visit_column(axis); }
