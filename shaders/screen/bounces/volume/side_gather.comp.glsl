#version 450 core
// What every side reflects of the virtual lights: A rho E [W]. Of those that it is near to, their sub-lights light it. Lights come in the order of their area lights, so that
// each one's shadow is looked up once.
#define SUBLIGHTS_BINDING 8
#include "screen/lights/resample/sublights.glsl"
#include "shared/global_index.shared.h"
#include "shared/grid.shared.h"
#include "shared/side.shared.h"
#include "screen/visibility/area_maps/virtual_area_light.shared.h"
#include "shared/virtual_light.shared.h"
#include "screen/visibility/area_maps/area_light_shadow.glsl"

layout(local_size_x = 64) in;
layout(std140, binding = 0) uniform GridBlock { Grid grid; };
layout(std140, binding = 1) uniform AreaLights { VirtualAreaLight area_lights[MAX_VIRTUAL_AREA_LIGHTS]; };
layout(std430, binding = 0) readonly buffer Lights { VirtualLight lights[]; };
layout(std430, binding = 1) readonly buffer Order { uint order[]; };
layout(std430, binding = 2) readonly buffer Clusters { uint cluster_of[]; };
layout(std430, binding = 3) readonly buffer CellSides { uvec2 cell_sides[]; };
layout(std430, binding = 4) readonly buffer Sides { Side sides[]; };
layout(std430, binding = 5) readonly buffer SideCount { uint side_count; };
layout(std430, binding = 6) writeonly buffer Emitted { vec4 emitted_flux[]; };
layout(std430, binding = 7) writeonly buffer Punctual { vec4 punctual_flux[]; };
uniform int light_count;
uniform float zone;  // areas of a light near which its sub-lights light instead; 0: none

const float SIMILAR_NORMAL_COSINE = 0.70710678;  // within 45 degrees

// A point for all of a side's surface, cell units: on the line through the middle of what the cell's other sides leave of the
// cell; those of its own surface leave all. propagation/light_in/side_start_internal.h.
vec3 middle_of(Side side) {
  ivec3 cell = cell_coord(grid, side.cell);
  uvec2 faces = cell_sides[side.cell];
  vec3 low = vec3(cell), high = low + 1.0;
  for (int face = 0; face < 6; ++face) {
    if (!has_side(faces, face)) continue;
    uint other = side_index(faces, face);
    if (dot(sides[other].normal, side.normal) >= SIMILAR_NORMAL_COSINE) continue;
    if (face_sign(face) < 0) low[face_axis(face)] = sides[other].depth;
    else high[face_axis(face)] = sides[other].depth;
  }
  vec3 off = mix(vec3(0.0), 0.5 * (low + high) - vec3(cell) - 0.5, lessThan(low, high));
  int axis = face_axis(side.face);
  off[axis] = 0.0;
  // Along the side's plane; a plane that the face's axis hardly meets is not followed far.
  float slope = max(abs(side.normal[axis]), 0.1) * (side.normal[axis] < 0.0 ? -1.0 : 1.0);
  vec3 middle = vec3(cell) + 0.5 + off;
  middle[axis] = side.depth - dot(side.normal, off) / slope;
  return middle;
}

void main() {
  uint s = global_index();
  if (s >= side_count || s >= uint(sides.length())) return;
  Side side = sides[s];
  vec3 position = world_from_cell(grid, middle_of(side));
  vec3 reflected = vec3(0.0), emitted = vec3(0.0);
  uint seen = NO_VIRTUAL_AREA_LIGHT;
  float visibility = 0.0;
  for (int i = 0; i < light_count; ++i) {
    uint index = order[i];
    uint cluster = cluster_of[index];
    if (cluster == NO_VIRTUAL_AREA_LIGHT) break;  // those come last
    VirtualLight l = lights[index];
    vec3 w = l.position - position;
    float squared = dot(w, w);
    float along = dot(w, side.normal), height = -dot(w, l.normal);
    float form = disk_to_point(max(height, 0.0), along, -dot(l.normal, side.normal), squared, l.area_m2);
    if (min(along, height) <= 0.0) form = 0.0;
    float share = far_share(disk_nearness(squared, l.area_m2), zone);
    if (form <= 0.0 && share >= 1.0) continue;
    if (cluster != seen) {
      seen = cluster;
      visibility = area_light_visibility(int(cluster), area_lights[cluster], position, side.normal);
    }
    vec3 irradiance = l.flux * (visibility * share * form);
    if (share < 1.0)
      // Nothing hides what is so near, as for pixels.
      irradiance += irradiance_of_sublights(Receiver(position, side.normal, side.normal), int(index), 1.0 - share, zone);
    if (l.kind == VIRTUAL_LIGHT_EMITTED) emitted += irradiance;
    else reflected += irradiance;
  }
  vec3 reflectance = side.albedo * side.area_m2;
  punctual_flux[s] = vec4(reflectance * reflected, 0.0);
  emitted_flux[s] = vec4(reflectance * emitted, 0.0);
}
