#version 450 core
// How a pixel's lobe is to be summed, by lights or by samples of pictures where fewer than nine lights lie in it, and
// how far a quarter of these samples see, as a share of their way: its mean and the mean of its square are what
// shadows are made of (Donnelly and Lauritzen 2006).
// Set by the program: VOXELS or FACES, what hides lights; PHONG, where mirrors are Phong lobes
#include "screen/gather/area/lobe_samples.glsl"
#include "shared/group_sizes.shared.h"
#ifdef VOXELS
#include "screen/visibility/screen_voxels/screen_voxels.glsl"
#endif
#ifdef FACES
#include "voxel/face_walk.glsl"
#endif

layout(local_size_x = SQUARE_GROUP, local_size_y = SQUARE_GROUP) in;
layout(binding = AREA_LOBE_KIND_IMAGE, r8ui) uniform writeonly uimage2D kinds;
layout(binding = AREA_LOBE_WAYS_IMAGE, rgba32f) uniform writeonly image2D ways[3];
uniform int light_count;

#define BODY_CELLS 1.2  // before a light

bool enough_lights(Receiver r) {
  int within = 0;
  for (int k = 0; k < light_count; ++k) {
    VirtualLight light = area_lights[k];
    vec3 w = light.position - r.position;
    float along = dot(r.lobe.mirrored, w);
    bool faces = min(-dot(w, light.normal), min(dot(w, r.lobe.normal), dot(w, r.geometric))) > 0.0;
    if (faces && along > 0.0 && pow(along * inversesqrt(dot(w, w)), r.lobe.exponent) > LEAST_OF_LOBE) ++within;
  }
  return within >= FEWEST_LIGHTS;
}

float seen_share(Receiver r, vec3 direction, PanelHit hit) {
#ifdef VOXELS
  VoxelWay way;
  VoxelEnd from = voxel_end(r.position, r.geometric);
  VoxelEnd to = voxel_end(r.position + hit.distance_m * direction, panels[hit.panel].normal);
  if (!voxel_way(from, to, way)) return 1.0;
  int met = first_voxel(way, 0);
  return met < way.steps ? (float(met) + 0.5) / float(way.steps) : 1.0;
#elif defined(FACES)
  vec3 point = cell_from_world(grid, r.position);
  float cells = hit.distance_m / grid.cell_size_m, left = 1.0;
  FaceWalk walk = begin_walk(point, r.geometric, direction);
  for (uint side = next_side(walk, cells - BODY_CELLS); side != NO_SIDE; side = next_side(walk, cells - BODY_CELLS)) {
    left *= 1.0 - sides[side].coverage;
    if (left <= 0.5) return min(walk.way / cells, 1.0);
  }
  return 1.0;
#else
  return 1.0;
#endif
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, textureSize(position_map, 0)))) return;
  Receiver r;
  uint kind = LOBE_NONE;
  vec4 found[3] = vec4[3](vec4(1.0), vec4(1.0), vec4(1.0));
  if (receiver_at(pixel, r)) kind = panel_count == 0 || enough_lights(r) ? LOBE_WIDE : LOBE_NARROW;
  if (kind == LOBE_NARROW) {
    mat3 frame = frame_around(r.lobe.mirrored);
    for (int m = 0; m < LOBE_SAMPLES / 4; ++m) {
      vec3 direction = lobe_sample(r.lobe, frame, 4 * m + sample_of(pixel)).direction;
      PanelHit hit = panel_along(r.position, direction);
      float share = 1.0;
      if (hit.panel >= 0 && min(dot(direction, r.lobe.normal), dot(direction, r.geometric)) > 0.0)
        share = seen_share(r, direction, hit);
      if ((m & 1) == 0) found[m >> 1].xy = vec2(share, share * share);
      else found[m >> 1].zw = vec2(share, share * share);
    }
  }
  imageStore(kinds, pixel, uvec4(kind));
  imageStore(ways[0], pixel, found[0]);
  imageStore(ways[1], pixel, found[1]);
  imageStore(ways[2], pixel, found[2]);
}
