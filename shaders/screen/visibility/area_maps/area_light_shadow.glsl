// How much of a virtual area light a point sees: one of three methods, which AreaLightShadow::define() chooses.
#ifndef VOLGI_AREA_LIGHT_SHADOW_GLSL
#define VOLGI_AREA_LIGHT_SHADOW_GLSL
#include "screen/visibility/area_maps/virtual_area_light.shared.h"

// A receiver in the frame of the area light: z along the light's normal.
struct ShadowReceiver {
  int layer;
  vec3 position;
  vec3 normal;
  float error_m;  // what positions err: 2^-20 of their numbers, as in shared/reflective_shadow_map.glsl
};

vec3 area_light_from_world(VirtualAreaLight light, vec3 v) {
  return vec3(dot(v, light.right), dot(v, cross(light.normal, light.right)), dot(v, light.normal));
}

ShadowReceiver shadow_receiver(int k, VirtualAreaLight light, vec3 position, vec3 normal) {
  vec3 q = area_light_from_world(light, position - light.position);
  return ShadowReceiver(k, q, area_light_from_world(light, normal),
                        (length(light.position) + 2.0 * length(q)) / 1048576.0);
}

// Angle [rad] that a texel of the map subtends: the map is conformal, and its scale on the disk is 2 / (1 + r^2).
float texel_angle(vec2 disk, int resolution) { return 4.0 / (float(resolution) * (1.0 + dot(disk, disk))); }

#include "screen/visibility/area_maps/shadow_comparison.glsl"
#if defined(AREA_LIGHT_SHADOW_CONVOLUTION)
#include "screen/visibility/area_maps/convolution_shadow.glsl"
#elif defined(AREA_LIGHT_SHADOW_PERCENTAGE_CLOSER)
#include "screen/visibility/area_maps/percentage_closer_shadow.glsl"
#else
#include "screen/visibility/area_maps/single_shadow.glsl"
#endif

// A light may have parts in front of the receiver's plane and its middle behind it. All that stands between is behind the
// plane then, and would not hide the receiver, as what is there does not (shadow_comparison.glsl): light came through
// walls. So what is looked for instead is a point of the air as far in front of the plane, which anything nearer hides.
ShadowReceiver in_front_of_its_plane(ShadowReceiver receiver) {
  float behind_m = dot(receiver.position, receiver.normal);
  if (behind_m <= receiver.error_m) return receiver;
  vec3 air = receiver.position + 2.0 * behind_m * receiver.normal;
  if (air.z > 0.0) receiver.position = air;
  receiver.normal = -normalize(receiver.position);
  return receiver;
}

// Share of area light `k` that reaches `position`, 0 to 1; `normal` is the receiver's geometric one, towards the
// viewer. 0 behind the light, which sends nothing there.
float area_light_visibility(int k, VirtualAreaLight light, vec3 position, vec3 normal) {
  ShadowReceiver receiver = shadow_receiver(k, light, position, normal);
  if (receiver.position.z <= 0.0) return 0.0;
  return receiver_visibility(light, in_front_of_its_plane(receiver));
}

#endif
