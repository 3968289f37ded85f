// Whether voxels of the camera's frustum lie on a straight way. ScreenVoxels::bind().
#ifndef VOLGI_SCREEN_VOXELS_GLSL
#define VOLGI_SCREEN_VOXELS_GLSL
#include "screen/visibility/screen_voxels/slots.shared.h"

layout(binding = VOXEL_BITS_UNIT) uniform usampler2DArray voxel_bits;
uniform mat4 voxel_clip_from_world;
uniform vec4 voxel_slice_from_world;
uniform int voxel_steps;
uniform float voxel_bias;  // voxels at each end

// Texels and slices; both are linear along a way but for the division by clip.w.
struct VoxelPlace {
  vec3 clip;  // x, y, w: texel = (x, y) / w
  float slice;
};

VoxelPlace voxel_place(vec3 world) {
  vec4 clip = voxel_clip_from_world * vec4(world, 1.0);
  float size = float(textureSize(voxel_bits, 0).x);
  return VoxelPlace(vec3((clip.xy + clip.w) * (0.5 * size), clip.w),
                    dot(voxel_slice_from_world.xyz, world) + voxel_slice_from_world.w);
}

// Length of a voxel at a place, its longer edge [m]. @param d  unit.
float voxel_m(vec3 world) {
  VoxelPlace here = voxel_place(world);
  float slice_m = 1.0 / length(voxel_slice_from_world.xyz);
  vec3 across = vec3(voxel_clip_from_world[0].x, voxel_clip_from_world[1].x, voxel_clip_from_world[2].x);
  float texel_m = 2.0 * max(here.clip.z, 1e-6) / (length(across) * float(textureSize(voxel_bits, 0).x));
  return max(slice_m, texel_m);
}

// Slices of a texel in [from, to].
bool any_voxel(ivec2 texel, float from, float to) {
  int last_slice = 32 * textureSize(voxel_bits, 0).z - 1;
  int first = clamp(int(floor(min(from, to))), 0, last_slice), last = clamp(int(floor(max(from, to))), 0, last_slice);
  bool hit = false;
  for (int word = first >> 5; word <= last >> 5; ++word) {
    int low = max(first - 32 * word, 0), high = min(last - 32 * word, 31);
    uint bits = (0xffffffffu >> uint(31 - high)) & (0xffffffffu << uint(low));
    hit = hit || (texelFetch(voxel_bits, ivec3(texel, word), 0).r & bits) != 0u;
  }
  return hit;
}

// Even samples along the way, each of all slices up to halfway to the next ones (Nichols 2010, section 5.3.3.1): as
// many as it crosses texels or slices. Off both surfaces by the bias, along their normals and along the way: in a
// corner the other wall's voxels are as near as the own.
bool voxels_hide(vec3 from, vec3 normal, vec3 to, vec3 to_normal) {
  vec3 d = normalize(to - from);
  VoxelPlace a = voxel_place(from + (normal + 0.5 * d) * (voxel_bias * voxel_m(from)));
  VoxelPlace b = voxel_place(to + (to_normal - 0.5 * d) * (voxel_bias * voxel_m(to)));
  float nearest_w = 1e-4;
  if (a.clip.z < nearest_w) return false;
  // Behind the camera nothing is known.
  float known = b.clip.z < nearest_w ? (a.clip.z - nearest_w) / (a.clip.z - b.clip.z) : 1.0;
  vec3 end_clip = mix(a.clip, b.clip, known);
  float end_slice = mix(a.slice, b.slice, known);
  vec2 texels = abs(end_clip.xy / end_clip.z - a.clip.xy / a.clip.z);
  int steps = clamp(int(ceil(max(max(texels.x, texels.y), 0.5 * abs(end_slice - a.slice)))), 1, voxel_steps);
  ivec2 size = textureSize(voxel_bits, 0).xy;
  float half_step = 0.5 * (end_slice - a.slice) / float(steps);
  for (int k = 0; k < steps; ++k) {
    float t = (float(k) + 0.5) / float(steps);
    vec3 clip = mix(a.clip, end_clip, t);
    float slice = mix(a.slice, end_slice, t);
    ivec2 texel = ivec2(floor(clip.xy / clip.z));
    if (any(lessThan(texel, ivec2(0))) || any(greaterThanEqual(texel, size))) continue;
    if (any_voxel(texel, slice - half_step, slice + half_step)) return true;
  }
  return false;
}

#endif
