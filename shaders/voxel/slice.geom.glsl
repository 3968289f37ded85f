#version 450 core
// One pass of slicing: the columns of `axis` in which the triangle may meet a line.
#include "voxel/rectangle.glsl"

uniform int axis;

void main() { emit_lines(axis); }
