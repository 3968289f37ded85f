#version 450 core
// Rays from virtual lights, each to the side that it meets first, which reflects its power.
#include "screen/base/virtual_lights.glsl"
#include "screen/bounces/volume/slots.shared.h"
#include "propagation/deposit.glsl"
#include "shared/constants.glsl"
#include "shared/global_index.shared.h"
#include "shared/group_sizes.shared.h"
#include "shared/near_light.shared.h"
#include "shared/octahedral.glsl"
#include "voxel/side_ray.glsl"

layout(local_size_x = LINEAR_GROUP) in;
layout(std430, binding = SENDERS_SLOT) readonly buffer Senders { SubLight sublights[]; };
uniform bool in_parts;  // fine sub-lights send, else the lights themselves
uniform int rays_per_sender;
uniform int first_sender;
uniform int ray_count;
uniform uint first_ray;

#define ALONG_AXES 1.02  // staircase factor: within a degree

struct Sender {
  vec3 position, normal, flux;
};

Sender sender_at(int i) {
  if (!in_parts) return Sender(lights[i].position, lights[i].normal, lights[i].flux);
  SubLight part = sublights[(i / FINE_SUBLIGHTS) * SUBLIGHTS_PER_LIGHT + COARSE_SUBLIGHTS + i % FINE_SUBLIGHTS];
  return Sender(part.position, octahedral_decode(unpackSnorm2x16(part.normal)), part.flux);
}

// Point n of an additive recurrence in the unit square (Roberts 2018): powers of 1/1.3247..., in units of 2^-32.
vec2 recurrence(uint n) { return vec2(uvec2(3242174889u * n, 2447445414u * n) >> 8) / 16777216.0; }

vec3 cosine_direction(vec3 normal, vec2 uv) {
  vec3 other = abs(normal.x) < 0.7 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0);
  vec3 right = normalize(cross(normal, other)), up = cross(normal, right);
  float radius = sqrt(uv.x), angle = 2.0 * PI * uv.y;
  return normalize(radius * (cos(angle) * right + sin(angle) * up) + sqrt(1.0 - uv.x) * normal);
}

void main() {
  int j = int(global_index());
  if (j >= ray_count) return;
  Sender sender = sender_at(first_sender + j / rays_per_sender);
  if (sender.flux == vec3(0.0)) return;
  uint n = first_ray + uint(j);
  vec3 met_at;
  int side = side_met(cell_from_world(grid, sender.position), sender.normal,
                      cosine_direction(sender.normal, recurrence(n)), n, met_at);
  if (side < 0) return;
  vec3 flux = sender.flux / float(rays_per_sender) * sides[side].albedo;
  // A tilted surface is a staircase, whose sides around the point share its light; one along the axes is what was met.
  if (staircase_factor(sides[side].normal) > ALONG_AXES) deposit(world_from_cell(grid, met_at), sides[side].normal, flux);
  else add_flux(side, flux);
}
