#version 450 core
// Irradiance of lights on emissive surfaces at the pixels of a list, and bits of which groups of lights are seen. A
// group on which all corners of the coarser level agree is not asked for again (Nichols 2010, section 5.3.3.2). Threads
// share out what ways their pixels ask for, or all would wait for the one that asks for most.
// Set by the program: FIRST, the coarsest level; VOXELS, FACES or RAYS, what hides lights. RAYS are the host's: what
// ASK has written down, it answers in the same place.
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
layout(binding = AREA_IRRADIANCE_IMAGE, rgba32f) uniform image2D irradiance;
layout(binding = AREA_MASK_IMAGE, rgba32ui) uniform uimage2D masks;
layout(std430, binding = AREA_LIST_SLOT) readonly buffer PixelList { WorkListHead head; uint listed[]; };
layout(std430, binding = AREA_LIGHTS_SLOT) readonly buffer AreaLights { VirtualLight area_lights[]; };
#ifdef RAYS
// Of each listed pixel and member a bit for each group.
layout(std430, binding = AREA_QUESTIONS_SLOT) buffer Questions { uvec2 questions[]; };
layout(std430, binding = AREA_ASKERS_SLOT) writeonly buffer Askers { vec4 askers[]; };  // positions and normals
#endif
layout(std430, binding = AREA_COUNTS_SLOT) buffer Counts { uint ways, ways_asked; };
uniform int light_count;
uniform int per_group;  // lights
uniform int shares;     // of each group every shares-th light is asked for, for those around it too
uniform int first;      // of each group's lights
uniform int end;        // of them, in this dispatch
uniform ivec2 groups;   // from, up to
uniform int begun;      // there were others before
uniform int incremental;

#define BODY_CELLS 1.2  // before a light

shared vec3 positions[LINEAR_GROUP], geometric_normals[LINEAR_GROUP];
shared uint open_bits[LINEAR_GROUP * 2];
shared uint ways_listed[LINEAR_GROUP * AREA_GROUPS];  // pixel, and group in the low bits
shared uint way_count, all_ways, all_asked;

int asked_light(int group, int member) { return min(group * per_group + member, light_count - 1); }

bool is_seen(vec3 position, vec3 normal, VirtualLight light) {
#ifdef VOXELS
  return !voxels_hide(voxel_end(position, normal), voxel_end(light.position, light.normal));
#elif defined(FACES)
  vec3 point = cell_from_world(grid, position), w = cell_from_world(grid, light.position) - point;
  float cells = length(w);
  FaceWalk walk = begin_walk(point, normal, w / cells);
  return open_share(walk, cells - BODY_CELLS) > 0.5;
#else
  return true;
#endif
}

// Irradiance, whatever lies between. Lights that look away or are black, and what looks away from them, are left out.
vec3 arriving(VirtualLight light, vec3 position, vec3 normal, vec3 geometric) {
  vec3 w = light.position - position;
  float height = -dot(w, light.normal), along = dot(w, normal);
  if (min(height, min(along, dot(w, geometric))) <= 0.0) return vec3(0.0);
  return light.flux * disk_to_point(height, along, -dot(light.normal, normal), dot(w, w), light.area_m2);
}

bool faces(VirtualLight light, vec3 position, vec3 normal, vec3 geometric) {
  vec3 w = light.position - position;
  return min(-dot(w, light.normal), min(dot(w, normal), dot(w, geometric))) > 0.0 && light.flux != vec3(0.0);
}

bool any_faces(int group, int member, vec3 position, vec3 normal, vec3 geometric) {
  int begin = group * per_group + member / shares * shares;
  bool any = false;
  for (int k = begin; k < min(begin + shares, light_count); ++k)
    any = any || faces(area_lights[k], position, normal, geometric);
  return any;
}

// Of the lights for which one of them is asked: as many as pixels share out.
vec3 arriving_of(int group, int member, vec3 position, vec3 normal, vec3 geometric) {
  int begin = group * per_group + member / shares * shares;
  vec3 sum = vec3(0.0);
  for (int k = begin; k < min(begin + shares, light_count); ++k)
    sum += arriving(area_lights[k], position, normal, geometric);
  return sum;
}

uint bits_between(ivec2 range, int first) {
  ivec2 r = clamp(range - first, 0, 32);
  return r.x >= r.y ? 0u : (0xffffffffu >> uint(32 - (r.y - r.x))) << uint(r.x);
}

#ifdef RAYS
// Of a thread that has a pixel.
uvec2 answers(int index, int member, uvec2 unknown) {
  int place = index * ((end - first + shares - 1) / shares) + (member - first) / shares;
#ifdef ASK
  questions[place] = unknown;
  return uvec2(0u);
#else
  return questions[place];
#endif
}
#else
// Of all threads of a group at once, which share out what they ask for.
uvec2 answers_of_group(int own, int member, uvec2 unknown) {
  uint at = atomicAdd(way_count, uint(bitCount(unknown.x) + bitCount(unknown.y)));
  open_bits[2 * own] = 0u;
  open_bits[2 * own + 1] = 0u;
  for (int word = 0; word < 2; ++word) {
    uint left = word == 0 ? unknown.x : unknown.y;
    for (; left != 0u; left &= left - 1u) ways_listed[at++] = uint(own * AREA_GROUPS + 32 * word + findLSB(left));
  }
  barrier();
  for (int k = own; k < int(way_count); k += LINEAR_GROUP) {
    int from = int(ways_listed[k]) / AREA_GROUPS, group = int(ways_listed[k]) % AREA_GROUPS;
    if (is_seen(positions[from], geometric_normals[from], area_lights[asked_light(group, member)]))
      atomicOr(open_bits[2 * from + group / 32], 1u << uint(group & 31));
  }
  barrier();
  if (own == 0) way_count = 0u;
  return uvec2(open_bits[2 * own], open_bits[2 * own + 1]);
}
#endif

void main() {
  int index = int(global_index()), own = int(gl_LocalInvocationIndex);
  bool listed_here = index < int(head.count);
  ivec2 pixel = listed_here ? unpack_pixel(listed[index]) : ivec2(0);
  vec3 position = texelFetch(position_map, pixel, 0).xyz;
  vec4 normals = texelFetch(normal_map, pixel, 0);
  vec3 normal = octahedral_decode(normals.xy), geometric = octahedral_decode(normals.zw);
  positions[own] = position;
  geometric_normals[own] = geometric;
  if (own == 0) {
    way_count = 0u;
    all_ways = 0u;
    all_asked = 0u;
  }
  uvec2 seen = uvec2(0u), hidden = uvec2(0u);
#ifndef FIRST
  if (incremental != 0 && listed_here) agreed(corners_of(pixel, position, normal), seen, hidden);
#endif
  vec3 sum = vec3(0.0);
  uvec2 some_seen = uvec2(0u), all_seen = uvec2(0xffffffffu), faced = uvec2(0u);
  barrier();
  for (int member = first; member < end; member += shares) {
    int end_group = min((light_count - member / shares * shares + per_group - 1) / per_group, groups.y);
    uvec2 facing = uvec2(0u);
    for (int group = groups.x; group < end_group; ++group) {
      if (!listed_here || !any_faces(group, member, position, normal, geometric)) continue;
      uint bit = 1u << uint(group & 31);
      if (group < 32) facing.x |= bit;
      else facing.y |= bit;
    }
    uvec2 open = facing & seen, unknown = facing & ~(seen | hidden);
    atomicAdd(all_ways, uint(bitCount(facing.x) + bitCount(facing.y)));
    atomicAdd(all_asked, uint(bitCount(unknown.x) + bitCount(unknown.y)));
#ifdef RAYS
    uvec2 found = listed_here ? answers(index, member, unknown) : uvec2(0u);
#else
    uvec2 found = answers_of_group(own, member, unknown);
#endif
    open |= found;
    for (int group = groups.x; group < end_group; ++group) {
      if (((group < 32 ? open.x : open.y) >> uint(group & 31) & 1u) != 0u)
        sum += arriving_of(group, member, position, normal, geometric);
    }
    faced |= facing;
    some_seen |= open;
    all_seen &= open | ~facing;
#ifndef RAYS
    barrier();
#endif
  }
#ifdef ASK
  if (!listed_here) return;
  askers[2 * index] = vec4(position, 0.0);
  askers[2 * index + 1] = vec4(geometric, 0.0);
#else
  if (listed_here) {
    uvec2 here = uvec2(bits_between(groups, 0), bits_between(groups, 32));
    uvec4 mask = uvec4((some_seen | ~faced) & here, all_seen);
    if (begun != 0) {
      uvec4 before = imageLoad(masks, pixel);
      mask = uvec4(mask.xy | before.xy, mask.zw & before.zw);
      sum += imageLoad(irradiance, pixel).rgb;
    }
    imageStore(irradiance, pixel, vec4(sum, 1.0));
    imageStore(masks, pixel, mask);
  }
  barrier();
  if (own == 0) {
    atomicAdd(ways, all_ways);
    atomicAdd(ways_asked, all_asked);
  }
#endif
}
