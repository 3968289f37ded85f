#version 450 core
// The square of each virtual area light, and a line along its normal.
#include "screen/views/view_camera.glsl"
#include "screen/visibility/area_maps/area_lights_block.glsl"
#include "shared/color_maps.shared.h"

flat out vec3 color;

const float MARGIN_PX = 4.0;
const float NORMAL_LENGTH = 0.25;  // of the square's edge

void main() {
  VirtualAreaLight light = area_lights[gl_InstanceID];
  vec3 up = cross(light.normal, light.right);
  int corner = (gl_VertexID + 1) / 2 & 3;
  vec2 at = vec2(corner == 1 || corner == 2 ? 0.5 : -0.5, corner >= 2 ? 0.5 : -0.5) * light.size_m;
  vec3 position = light.position + at.x * light.right + at.y * up;
  if (gl_VertexID >= 8) position = light.position + light.normal * (float(gl_VertexID - 8) * NORMAL_LENGTH * light.size_m);
  color = hashed_color(uint(gl_InstanceID));
  float w = max((clip_from_world * vec4(position, 1.0)).w, 0.0);
  gl_Position = light.light_count == 0 ? NOWHERE : clip_position(position, MARGIN_PX * pixel_at_1_m * w);
}
