#version 450 core
// Every fragment stands for a piece of surface and adds it to the sides that show it, once for the cells in front of the
// triangle and once for those behind. Fixed point: sums do not depend on order.
#include "shared/material.glsl"
#include "voxel/find_side.glsl"

in vec2 v_uv0;
in vec2 v_uv1;
in vec4 v_color;
in vec3 v_position;
flat in vec3 v_normal;

uniform int axis;
uniform float samples_per_cell;  // along each of the two axes
layout(std430, binding = 0) buffer AreaFixed { uint area_fixed[]; };  // 2^-20 h^2

void add_area(vec3 normal, int front, float area) {
  ivec3 targets;
  vec3 weights;
  sides_of_point(v_position, normal, front, targets, weights);
  for (int a = 0; a < 3; ++a) {
    if (weights[a] > 0.0) atomicAdd(area_fixed[targets[a]], uint(weights[a] * area * 1048576.0 + 0.5));
  }
}

void main() {
  float stopped = material_coverage(material_albedo_alpha(v_uv0, v_uv1, v_color).a);
  if (stopped <= 0.0) discard;
  float area = stopped / (samples_per_cell * samples_per_cell * abs(v_normal[axis]));
  add_area(v_normal, 1, area);
  add_area(-v_normal, 0, area);
}
