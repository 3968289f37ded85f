#version 450 core
// Adds what every side sends of the light of one punctual light, at four points of it.
#include "screen/bounces/glossy/slots.shared.h"
#include "shared/global_index.shared.h"
#include "shared/group_sizes.shared.h"
#include "shared/reflective_shadow_map.glsl"
#include "voxel/grid_block.glsl"
#include "voxel/side_count.glsl"
#include "voxel/side_middle.glsl"
#include "voxel/sides.glsl"

layout(local_size_x = LINEAR_GROUP) in;
layout(std430, binding = GLOSSY_RADIOSITY_SLOT) buffer Radiosity { vec4 radiosity[]; };
uniform int light;

void main() {
  uint s = global_index();
  if (s >= side_count || s >= uint(sides.length())) return;
  Side side = sides[s];
  vec3 middle = middle_of(side);
  int axis = face_axis(side.face);
  float slope = max(abs(side.normal[axis]), 0.1) * (side.normal[axis] < 0.0 ? -1.0 : 1.0);
  vec3 sum = vec3(0.0);
  for (int k = 0; k < 4; ++k) {
    vec3 off = vec3(0.0);
    off[axis_b(axis)] = float(k & 1) * 0.5 - 0.25;
    off[axis_c(axis)] = float(k >> 1) * 0.5 - 0.25;
    off[axis] = -dot(side.normal, off) / slope;
    // Beside its surface by what depths are rounded to.
    vec3 position = world_from_cell(grid, middle + off) + side.normal * (grid.cell_size_m * 2.0 / float(SLICE_STEPS));
    vec3 to_light;
    vec3 irradiance = perpendicular_irradiance(rsm_lights[light].light, position, to_light);
    float cosine = dot(side.normal, to_light);
    if (cosine > 0.0 && irradiance != vec3(0.0))
      sum += irradiance * (0.25 * cosine * rsm_visibility(light, RsmReceiver(position, side.normal, side.normal)));
  }
  radiosity[s] += vec4(side.albedo * sum, 0.0);
}
