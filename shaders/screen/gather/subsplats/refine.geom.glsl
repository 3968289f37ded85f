#version 450 core
// One step of the refinement (Nichols 2010, §3.2.3): a subsplat of `level` gives way to its four parts, or stays; those
// of other levels stay. What shows nothing goes. EACH_LIGHT: by illumination.
#include "screen/gather/subsplats/refinement_step.glsl"

layout(points) in;
layout(points, max_vertices = 4) out;
in uvec2 listed[];
out uvec2 refined;

void main() {
  Subsplat s = unpack_subsplat(listed[0].x);
  if (!has_surface(s)) return;
  if (!gives_way(s, listed[0].y)) {
    refined = listed[0];
    EmitVertex();
    return;
  }
  for (int k = 0; k < 4; ++k) {
    Subsplat part = part_of(s, k);
    if (!is_there(part)) continue;
    refined = uvec2(pack_subsplat(part), listed[0].y);
    EmitVertex();
  }
}
