#version 450 core
// A square for each side of the volume, on its cell's face, as the cell sees it.
#include "screen/views/view_camera.glsl"
#include "screen/views/view_modes.shared.h"
#include "shared/color_maps.shared.h"
#include "shared/constants.glsl"
#include "shared/tone_map.shared.h"
#include "voxel/grid_block.glsl"

// Once an instance, from its Side and its irradiances.
layout(location = 0) in vec4 normal_coverage;
layout(location = 1) in vec3 albedo;
layout(location = 2) in vec3 radiosity;
layout(location = 3) in ivec2 cell_face;
layout(location = 4) in vec3 direct_irradiance;
layout(location = 5) in vec3 indirect_irradiance;

uniform int mode;
uniform float exposure;  // factor

flat out vec3 color;
out vec2 on_face;  // -1 to 1 across the face

const float GAP = 0.06;  // of the face's edge, where it has pixels enough to show one

// As a white surface would show it.
vec3 light_color(vec3 irradiance) { return display_from_linear(irradiance * (exposure / PI)); }

vec3 side_color() {
  switch (mode) {
    case VIEW_SIDE_INDIRECT:
      return light_color(indirect_irradiance);
    case VIEW_SIDE_DIRECT:
      return light_color(direct_irradiance);
    case VIEW_SIDE_IRRADIANCE:
      return light_color(direct_irradiance + indirect_irradiance);
    case VIEW_SIDE_ALBEDO:
      return srgb_encode(albedo);
    case VIEW_SIDE_COVERAGE:
      return viridis(normal_coverage.w);
    case VIEW_SIDE_NORMAL:
      return 0.5 + 0.5 * normal_coverage.xyz;
    default:  // emitted radiance
      return light_color(radiosity);
  }
}

void main() {
  int axis = face_axis(cell_face.y);
  vec3 outwards = vec3(face_step(cell_face.y));
  vec3 middle = vec3(cell_coord(grid, cell_face.x)) + 0.5 + 0.5 * outwards;
  on_face = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
  vec3 along = vec3(0.0);
  along[axis_b(axis)] = on_face.x;
  along[axis_c(axis)] = on_face.y;
  color = side_color();
  bool seen_from_behind = dot(outwards, to_viewer(world_from_cell(grid, middle))) >= 0.0;
  float distance_w = (clip_from_world * vec4(world_from_cell(grid, middle), 1.0)).w;
  float face_px = grid.cell_size_m / max(pixel_at_1_m * distance_w, 1e-30);
  float filled = 1.0 - GAP * smoothstep(20.0, 40.0, face_px);
  vec3 corner = world_from_cell(grid, middle + 0.5 * filled * along);
  gl_Position = seen_from_behind ? NOWHERE : clip_position(corner, 0.0);
}
