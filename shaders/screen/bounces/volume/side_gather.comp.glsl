#version 450 core
// What every side reflects of the virtual lights: A rho E [W]. Of those that it is near to, their sub-lights light it.
// Lights come in the order of their area lights, so that each one's shadow is looked up once.
#include "screen/bounces/volume/slots.shared.h"
#define SUBLIGHTS_SLOT SIDE_SUBLIGHTS_SLOT
#include "screen/lights/resample/sublights.glsl"
#include "shared/global_index.shared.h"
#include "shared/group_sizes.shared.h"
#include "screen/visibility/area_maps/area_light_shadow.glsl"
#include "screen/visibility/area_maps/area_lights_block.glsl"
#include "screen/visibility/area_maps/light_order.glsl"
#include "voxel/grid_block.glsl"
#include "voxel/open_way.glsl"
#include "voxel/side_count.glsl"
#include "voxel/side_middle.glsl"
#include "voxel/sides.glsl"

layout(local_size_x = LINEAR_GROUP) in;
layout(std430, binding = GATHERED_EMITTED_SLOT) writeonly buffer Emitted { vec4 emitted_flux[]; };
layout(std430, binding = GATHERED_PUNCTUAL_SLOT) writeonly buffer Punctual { vec4 punctual_flux[]; };
layout(std430, binding = SIDE_NEAR_LIGHTS_SLOT) readonly buffer NearLights { NearLight near_lights[]; };
uniform int light_count;
uniform int apart;  // as near_lights.glsl has it
uniform float zone;  // areas of a light near which its sub-lights light instead; 0: none

// Maps are drawn from too far away for what is so near: cells tell what hides it.
bool reaches(VirtualLight l, Side side) {
  ivec3 cell;
  return cell_in_front(cell_from_world(grid, l.position), l.normal, cell) && open_way(cell, cell_coord(grid, side.cell));
}

void main() {
  uint s = global_index();
  if (s >= side_count || s >= uint(sides.length())) return;
  Side side = sides[s];
  vec3 position = world_from_cell(grid, middle_of(side));
  // Depths are rounded as vertices are, by 3/2 steps at most: from behind its own surface a side would see no light.
  vec3 beside = position + side.normal * (grid.cell_size_m * 2.0 / float(SLICE_STEPS));
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
    float reach = apart != 0 ? sqrt(2.0 * zone * l.area_m2) + near_lights[index].spread_m : 0.0;
    bool near = apart != 0 ? squared < reach * reach : share < 1.0;
    if (form <= 0.0 && !near) continue;
    if (cluster != seen) {
      seen = cluster;
      visibility = area_light_visibility(int(cluster), area_lights[cluster], beside, side.normal);
    }
    vec3 irradiance = l.flux * (visibility * share * form);
    if (near && reaches(l, side)) {
      Receiver at = Receiver(position, side.normal, side.normal);
      irradiance += apart != 0 ? irradiance_of_sublights_apart(at, int(index), l.area_m2, COARSE_SUBLIGHTS, zone)
                               : irradiance_of_sublights(at, int(index), 1.0 - share, zone);
    }
    if (l.kind == VIRTUAL_LIGHT_EMITTED) emitted += irradiance;
    else reflected += irradiance;
  }
  vec3 reflectance = side.albedo * side.area_m2;
  punctual_flux[s] = vec4(reflectance * reflected, 0.0);
  emitted_flux[s] = vec4(reflectance * emitted, 0.0);
}
