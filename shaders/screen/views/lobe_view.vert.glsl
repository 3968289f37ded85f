#version 450 core
// The radiance of one cell as a surface around its centre, as far away as radiance is great; with CUBE the cell's edges.
#include "screen/views/slots.shared.h"
#include "screen/views/view_camera.glsl"
#include "shared/constants.glsl"
#include "shared/grid.shared.h"
#include "shared/luminance.glsl"
#include "shared/sh.shared.h"

uniform ivec3 cell;
uniform vec3 centre;  // of the cell
uniform float cell_size_m;

#ifdef CUBE

flat out vec3 color;

void main() {
  int edge = gl_VertexID / 2, axis = edge / 4;
  vec3 corner;
  corner[axis] = float(gl_VertexID & 1);
  corner[axis_b(axis)] = float(edge & 1);
  corner[axis_c(axis)] = float((edge >> 1) & 1);
  color = vec3(1.0, 0.9, 0.3);
  gl_Position = clip_position(centre + (corner - 0.5) * cell_size_m, 0.0);
}

#else

layout(binding = VIEWED_RADIANCE_UNIT) uniform sampler3D radiance_sh;  // coefficients stacked in z
uniform int coefficients;                                              // 4 or 9
uniform int layers;                                                    // of cells in z
uniform float radius_m;                                                // where the root of the mean square is

out vec3 radiance;
out vec3 position;

vec3 coefficient(int i) { return texelFetch(radiance_sh, cell + ivec3(0, 0, i * layers), 0).rgb; }

float basis(int i, vec3 direction) {
  if (i < 4) return sh_basis_1(direction)[i];
  return i < 8 ? sh_basis_2(direction)[i - 4] : sh_basis_22(direction);
}

// Corners of the two triangles of every field between the rings and segments of a sphere.
vec3 direction_of(int vertex) {
  int field = vertex / 6, corner = vertex % 6;
  int right = corner == 1 || corner == 2 || corner == 4 ? 1 : 0, down = corner == 2 || corner >= 4 ? 1 : 0;
  float theta = PI * float(field / LOBE_SEGMENTS + down) / float(LOBE_RINGS);
  float phi = 2.0 * PI * float(field % LOBE_SEGMENTS + right) / float(LOBE_SEGMENTS);
  return vec3(sin(theta) * cos(phi), cos(theta), sin(theta) * sin(phi));
}

void main() {
  vec3 direction = direction_of(gl_VertexID);
  radiance = vec3(0.0);
  float squares = 0.0;
  for (int i = 0; i < coefficients; ++i) {
    vec3 c = coefficient(i);
    radiance += c * basis(i, direction) / sqrt(4.0 * PI);
    squares += luminance(c) * luminance(c);
  }
  float mean_square_root = sqrt(squares / (4.0 * PI));
  float distance_m = radius_m * abs(luminance(radiance)) / max(mean_square_root, 1e-30);
  position = centre + distance_m * direction;
  gl_Position = clip_position(position, 0.0);
}

#endif
