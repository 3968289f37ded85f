// Keys by which the surface nearest to each of a face's two cells is found: from the top, off the centre line [1 bit],
// depth, number of the fine line in its column [4], triangle [triangle_bits]. The line through the cells' centres speaks
// first; nothing depends on the order of fragments.
#include "voxel/families.glsl"

#ifndef FAMILIES
#define FAMILIES 1  // bound at once: 1 when slicing, 3 in the single pass
#endif
uniform int triangle_bits;

uint key_triangle(uint triangle) { return triangle & ((1u << triangle_bits) - 1u); }
int key_line(uint key) { return int(key >> triangle_bits) & 15; }
bool key_of_triangle(uint key, uint triangle) { return key_triangle(key) == key_triangle(triangle); }

// `ahead`: depth within the face's segment, 0 at the centre of its lower cell and 1 at that of its upper one.
void make_keys(float ahead, int line, uint triangle, out uint low, out uint high) {
  int depth_bits = 27 - triangle_bits;
  uint depth_max = (1u << depth_bits) - 1u;
  uint depth = min(uint(clamp(ahead, 0.0, 1.0) * float(depth_max)), depth_max - 1u);
  uint rest = (uint(line) << triangle_bits) | key_triangle(triangle);
  uint off_centre = line == 4 ? 0u : 0x80000000u;
  low = off_centre | (depth << (triangle_bits + 4)) | rest;
  high = off_centre | ((depth_max - 1u - depth) << (triangle_bits + 4)) | rest;
}

// Faces of one axis: offset, place as its family counts it (face, column).
int face_offset(int axis, ivec3 place) {
  ivec3 cells = in_family(grid.cells, axis);
  return place.y + cells.y * (place.z + cells.z * place.x);
}
