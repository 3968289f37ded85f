// One comparison with a paraboloid depth map.
#ifndef VOLGI_SHADOW_COMPARISON_GLSL
#define VOLGI_SHADOW_COMPARISON_GLSL
#include "screen/visibility/area_maps/slots.shared.h"

layout(binding = SHADOW_DISTANCE_UNIT) uniform sampler2DArray shadow_distance;  // [m]; infinity: nothing there

// Whether what a texel sees, `distance_m` away, hides the receiver. It does when it lies on the light's side of the
// receiver's plane: points of that plane fail whatever the texel's size and the angle, so that no bias grows with them.
// And when it is nearer than the receiver by more than a texel's edge: a wall that the receiver's floor meets is seen
// by the same texels, and its distance changes by that much across one where it stands at 45 degrees to the view.
bool comparison_hides(ShadowReceiver receiver, vec2 disk, float distance_m, float receiver_m, float edge_m) {
  if (!(distance_m < receiver_m - edge_m)) return false;
  vec3 occluder = direction_from_paraboloid(disk) * distance_m;
  return dot(occluder - receiver.position, receiver.normal) > receiver.error_m;
}

vec2 disk_of_shadow_texel(ivec2 texel, int resolution) {
  return (vec2(texel) + 0.5) * (2.0 / float(resolution)) - 1.0;
}

#endif
