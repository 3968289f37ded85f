#version 450 core
// Gives the sides the areas that side_area has counted.
#include "shared/global_index.shared.h"
#include "shared/grid.shared.h"
#include "shared/side.shared.h"

layout(local_size_x = 64) in;
layout(std140, binding = 0) uniform GridBlock { Grid grid; };
layout(std430, binding = 0) readonly buffer AreaFixed { uint area_fixed[]; };
layout(std430, binding = 4) buffer Sides { Side sides[]; };
layout(std430, binding = 5) readonly buffer SideCount { uint side_count; };

void main() {
  uint i = global_index();
  if (i >= side_count) return;
  float area_m2 = float(area_fixed[i]) / 1048576.0 * grid.cell_size_m * grid.cell_size_m;
  sides[i].area_m2 = max(area_m2, SIDE_LEAST_FILL * sides[i].face_m2 / staircase_factor(sides[i].normal));
}
