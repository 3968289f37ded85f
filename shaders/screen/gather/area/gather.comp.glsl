#version 450 core
// Irradiance of lights on emissive surfaces at the pixels of a list, and a bit for each of whether it is seen. A light
// that all corners of the coarser level see, or none, is not asked again (Nichols 2010, section 5.3.3.2).
// Set by the program: FIRST, the coarsest level; VOXELS or FACES, what hides lights
#include "screen/base/coarse_pixels.glsl"
#include "screen/gather/area/area_level.glsl"
#include "shared/disk_to_point.shared.h"
#include "shared/group_sizes.shared.h"
#include "shared/virtual_light.shared.h"
#ifdef VOXELS
#include "screen/visibility/screen_voxels/screen_voxels.glsl"
#endif
#ifdef FACES
#include "voxel/face_walk.glsl"
#endif

layout(local_size_x = LINEAR_GROUP) in;
layout(binding = AREA_IRRADIANCE_IMAGE, rgba32f) uniform writeonly image2D irradiance;
layout(binding = AREA_MASK_IMAGE, rgba32ui) uniform writeonly uimage2D mask_low;
layout(binding = AREA_MASK_IMAGE + 1, rgba32ui) uniform writeonly uimage2D mask_high;
layout(std430, binding = AREA_LIST_SLOT) readonly buffer PixelList { WorkListHead head; uint listed[]; };
layout(std430, binding = AREA_LIGHTS_SLOT) readonly buffer AreaLights { VirtualLight area_lights[]; };
layout(std430, binding = AREA_COUNTS_SLOT) buffer Counts { uint ways, ways_asked; };
uniform int light_count;
uniform int incremental;

#define BODY_CELLS 1.2  // before a light

bool is_seen(vec3 position, vec3 normal, VirtualLight light) {
#ifdef VOXELS
  return !voxels_hide(position, normal, light.position, light.normal);
#elif defined(FACES)
  vec3 point = cell_from_world(grid, position), w = cell_from_world(grid, light.position) - point;
  float cells = length(w);
  FaceWalk walk = begin_walk(point, normal, w / cells);
  return open_share(walk, cells - BODY_CELLS) > 0.5;
#else
  return true;
#endif
}

void main() {
  int index = int(global_index());
  if (index >= int(head.count)) return;
  ivec2 pixel = unpack_pixel(listed[index]);
  vec3 position = texelFetch(position_map, pixel, 0).xyz;
  vec4 normals = texelFetch(normal_map, pixel, 0);
  vec3 normal = octahedral_decode(normals.xy), geometric = octahedral_decode(normals.zw);
  uvec4 seen[2] = uvec4[2](uvec4(0u), uvec4(0u)), hidden[2] = uvec4[2](uvec4(0u), uvec4(0u));
#ifndef FIRST
  if (incremental != 0) {
    Corners c = corners_of(pixel, position, normal);
    agreed(c, 0, seen[0], hidden[0]);
    agreed(c, 1, seen[1], hidden[1]);
  }
#endif
  vec3 sum = vec3(0.0);
  uvec4 mask[2] = uvec4[2](uvec4(0u), uvec4(0u));
  uint shone = 0u, asked = 0u;
  for (int word = 0; word < 8 && 32 * word < light_count; ++word) {
    uint known_seen = word < 4 ? seen[0][word] : seen[1][word - 4];
    uint known_hidden = word < 4 ? hidden[0][word] : hidden[1][word - 4];
    uint bits = 0u;
    int end = min(light_count - 32 * word, 32);
    for (int k = 0; k < end; ++k) {
      VirtualLight light = area_lights[32 * word + k];
      vec3 w = light.position - position;
      float height = -dot(w, light.normal), along = dot(w, normal);
      // Lights that look away or are black, and what looks away from them, are left out; a bit is what other surfaces
      // do.
      bool faces = min(height, min(along, dot(w, geometric))) > 0.0 && light.flux != vec3(0.0);
      bool open = true;
      if (faces) {
        ++shone;
        open = (known_seen >> uint(k) & 1u) != 0u;
        if (((known_seen | known_hidden) >> uint(k) & 1u) == 0u) {
          ++asked;
          open = is_seen(position, geometric, light);
        }
      }
      if (open) bits |= 1u << uint(k);
      if (faces && open)
        sum += light.flux * disk_to_point(height, along, -dot(light.normal, normal), dot(w, w), light.area_m2);
    }
    if (word < 4) mask[0][word] = bits;
    else mask[1][word - 4] = bits;
  }
  imageStore(irradiance, pixel, vec4(sum, 1.0));
  imageStore(mask_low, pixel, mask[0]);
  imageStore(mask_high, pixel, mask[1]);
  atomicAdd(ways, shone);
  atomicAdd(ways_asked, asked);
}
