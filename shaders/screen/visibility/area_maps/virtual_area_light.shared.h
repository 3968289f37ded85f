// Virtual area lights: clusters of virtual point lights that share one visibility. Dong et al. 2009, sections 4 to 6.
#ifndef VOLGI_VIRTUAL_AREA_LIGHT_SHARED_H
#define VOLGI_VIRTUAL_AREA_LIGHT_SHARED_H
#include "shared/base.shared.h"
SHARED_BEGIN

#define MAX_VIRTUAL_AREA_LIGHTS 1024       // one uniform block
#define NO_VIRTUAL_AREA_LIGHT 0xffffffffu  // cluster of a virtual light without flux

// std140 and std430, 64 bytes. A cluster without lights has light_count 0; its other members are of no use.
struct VirtualAreaLight {
  vec3 position;  // where its lights are seen from, centred frame
  float area_m2;  // bounding rectangle on the plane of the mean normal, at least the sum of its lights' areas
  vec3 normal;    // unit, mean; the axis of its paraboloid map
  float size_m;   // Delta of the paper: edge of the square of area_m2
  vec3 right;     // unit, across the normal; up = cross(normal, right)
  int light_count;
  vec3 flux;        // sum over its lights [W]
  int first_light;  // its lights are order[first_light, first_light + light_count)
};
#ifdef __cplusplus
static_assert(sizeof(VirtualAreaLight) == 64 && offsetof(VirtualAreaLight, right) == 32);
#endif

// Paraboloid map of the hemisphere around an axis (which is the stereographic projection): unit direction with z along
// the axis, z >= 0, to the unit disk and back.
SHARED_FUNCTION vec2 paraboloid_from_direction(vec3 unit) { return vec2(unit.x, unit.y) / (1.0f + unit.z); }
SHARED_FUNCTION vec3 direction_from_paraboloid(vec2 disk) {
  float squared = dot(disk, disk);
  return vec3(2.0f * disk.x, 2.0f * disk.y, 1.0f - squared) / (1.0f + squared);
}

SHARED_END
#endif
