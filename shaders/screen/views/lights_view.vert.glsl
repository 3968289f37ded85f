#version 450 core
// A disk for each virtual or negative light, in the picture's plane; with TICKS a line along its normal.
#include "screen/views/lights_view.glsl"
#include "screen/views/view_camera.glsl"
#include "screen/views/view_modes.shared.h"
#include "shared/color_maps.shared.h"
#include "shared/constants.glsl"
#include "shared/tone_map.shared.h"

// Once an instance, from its VirtualLight, or NegativeLight, and the list of clusters.
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 flux;
layout(location = 3) in int source;
layout(location = 4) in int cluster;

layout(std140, binding = TOTAL_FLUX_BLOCK) uniform Total { float total_flux; };
uniform int mode;
uniform int negative;
uniform float share;            // of the picture, for all lights together
uniform float least_radius_px;  // of a light that has flux
uniform float tick_px;

flat out vec3 color;
flat out float radius_px;
out vec2 on_disk;  // its rim is at length 1

const vec3 EMITTED_COLOR = vec3(1.0, 0.95, 0.7);
const vec3 NEGATIVE_COLOR = vec3(0.25, 0.45, 1.0);
const float MARGIN_PX = 2.0;  // in front of the light's own surface

vec3 light_color() {
  if (negative != 0) return NEGATIVE_COLOR;
  if (mode == VIEW_LIGHT_CLUSTER) return hashed_color(uint(cluster));
  if (mode == VIEW_LIGHT_SOURCE) return source < 0 ? EMITTED_COLOR : hashed_color(uint(source));
  return srgb_encode(flux / max(max(max(flux.r, flux.g), flux.b), 1e-30));
}

void main() {
  float own_flux = mean_flux(flux);
  radius_px = max(sqrt(share * picture_size.x * picture_size.y * own_flux / (PI * total_flux)), least_radius_px);
  color = light_color();
  on_disk = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
  float w = (clip_from_world * vec4(position, 1.0)).w;
  gl_Position = NOWHERE;
  if (!(own_flux > 0.0) || w <= 0.0) return;
  float pixel_m = pixel_at_1_m * w;
#ifdef TICKS
  color = mix(color, vec3(1.0), 0.25);
  vec3 end = position + normal * (float(gl_VertexID) * tick_px * pixel_m);
  gl_Position = clip_position(end, (radius_px + MARGIN_PX) * pixel_m);
#else
  // As far in front as it is wide, so that half of it does not end in a wall that it lies on.
  gl_Position = clip_position(position, (radius_px + MARGIN_PX) * pixel_m);
  gl_Position.xy += on_disk * (2.0 * radius_px / picture_size) * gl_Position.w;
#endif
}
