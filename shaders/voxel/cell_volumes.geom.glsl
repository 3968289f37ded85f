#version 450 core
// Every piece of surface once: each triangle along the axis nearest to its geometric normal.
#include "voxel/rectangle.glsl"

void main() { emit_lines(longest_axis(c_normal[0])); }
