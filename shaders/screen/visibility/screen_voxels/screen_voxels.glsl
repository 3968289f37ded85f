// Whether voxels of the camera's frustum lie on a straight way. ScreenVoxels::bind().
#ifndef VOLGI_SCREEN_VOXELS_GLSL
#define VOLGI_SCREEN_VOXELS_GLSL
#include "screen/visibility/screen_voxels/slots.shared.h"

// 32 slices a layer; then as many layers of what VOXEL_RUN x VOXEL_RUN texels from each on hold.
layout(binding = VOXEL_BITS_UNIT) uniform usampler2DArray voxel_bits;
uniform mat4 voxel_clip_from_world;
uniform vec4 voxel_slice_from_world;
uniform int voxel_steps;
uniform float voxel_bias;  // voxels at each end

// Where something is among voxels: x, y, w and slice, texel = (x, y) / w. Linear along a way.
vec4 voxel_place(vec4 world) {
  vec4 clip = voxel_clip_from_world * world;
  float size = float(textureSize(voxel_bits, 0).x);
  return vec4((clip.xy + clip.w) * (0.5 * size), clip.w, dot(voxel_slice_from_world, world));
}

// An end of a way: on a surface, off it by the bias along its normal, and how much of the way is left out there [m].
// In a corner the other wall's voxels are as near as the own, so it is both.
struct VoxelEnd {
  vec3 world;
  vec4 place, off;
  float left_out_m;
};

VoxelEnd voxel_end(vec3 world, vec3 normal) {
  VoxelEnd end;
  end.world = world;
  end.place = voxel_place(vec4(world, 1.0));
  // Longer edge of a voxel there.
  float slice_m = 1.0 / length(voxel_slice_from_world.xyz);
  vec3 across = vec3(voxel_clip_from_world[0].x, voxel_clip_from_world[1].x, voxel_clip_from_world[2].x);
  float texel_m = 2.0 * max(end.place.z, 1e-6) / (length(across) * float(textureSize(voxel_bits, 0).x));
  float bias_m = voxel_bias * max(slice_m, texel_m);
  end.off = bias_m * voxel_place(vec4(normal, 0.0));
  end.left_out_m = 0.5 * bias_m;
  return end;
}

ivec2 voxel_texel(vec4 place) { return ivec2(floor(place.xy / place.z)); }

// Slices of a texel in [from, to]. @param first_layer  of the voxels, or of the wide ones.
bool any_voxel(ivec2 texel, int first_layer, float from, float to) {
  int last_slice = 16 * textureSize(voxel_bits, 0).z - 1;
  int first = clamp(int(floor(min(from, to))), 0, last_slice), last = clamp(int(floor(max(from, to))), 0, last_slice);
  bool hit = false;
  for (int word = first >> 5; word <= last >> 5; ++word) {
    int low = max(first - 32 * word, 0), high = min(last - 32 * word, 31);
    uint bits = (0xffffffffu >> uint(31 - high)) & (0xffffffffu << uint(low));
    hit = hit || (texelFetch(voxel_bits, ivec3(texel, first_layer + word), 0).r & bits) != 0u;
  }
  return hit;
}

// Even samples along a way, each of all slices up to halfway to the next ones (Nichols 2010, section 5.3.3.1): as many
// as it crosses texels or slices.
struct VoxelWay {
  vec4 from, to;
  int steps;
};

// False: nothing is known of it.
bool voxel_way(VoxelEnd from, VoxelEnd to, out VoxelWay way) {
  vec4 along = (to.place - from.place) / distance(from.world, to.world);
  way.from = from.place + from.off + from.left_out_m * along;
  way.to = to.place + to.off - to.left_out_m * along;
  way.steps = 0;
  float nearest_w = 1e-4;
  if (way.from.z < nearest_w) return false;
  // Behind the camera nothing is known.
  if (way.to.z < nearest_w) way.to = mix(way.from, way.to, (way.from.z - nearest_w) / (way.from.z - way.to.z));
  vec2 texels = abs(way.to.xy / way.to.z - way.from.xy / way.from.z);
  float most = max(max(texels.x, texels.y), 0.5 * abs(way.to.w - way.from.w));
  way.steps = clamp(int(ceil(most)), 1, voxel_steps);
  return true;
}

// The first sample from `first` on that meets a voxel, or way.steps. Of VOXEL_RUN samples that lie in as many texels
// one look says whether any can. One loop for both kinds of look: lanes of a processor that go together would wait for
// each other at the end of an inner one.
int first_voxel(VoxelWay way, int first) {
  ivec2 last_texel = textureSize(voxel_bits, 0).xy - 1;
  int wide_layer = textureSize(voxel_bits, 0).z / 2;
  vec4 by = (way.to - way.from) / float(way.steps);
  float half_step = 0.5 * by.w;
  int singly_to = first;  // samples before this one by one
  for (int k = first; k < way.steps;) {
    bool single = k < singly_to;
    int end = single ? k + 1 : min(k + VOXEL_RUN, way.steps);
    vec4 a = way.from + (float(k) + 0.5) * by, b = way.from + (float(end) - 0.5) * by;
    ivec2 texel_a = voxel_texel(a), texel_b = voxel_texel(b), low = min(texel_a, texel_b);
    bool looks = single ? texel_a == clamp(texel_a, ivec2(0), last_texel)
                        : all(lessThan(abs(texel_a - texel_b), ivec2(VOXEL_RUN)));
    bool hit = looks && any_voxel(clamp(low, ivec2(0), last_texel), single ? 0 : wide_layer, a.w - half_step,
                                  b.w + half_step);
    if (hit && single) return k;
    if (single || (looks && !hit)) k = end;
    else singly_to = end;
  }
  return way.steps;
}

bool voxels_hide(VoxelEnd from, VoxelEnd to) {
  VoxelWay way;
  return voxel_way(from, to, way) && first_voxel(way, 0) < way.steps;
}

#endif
