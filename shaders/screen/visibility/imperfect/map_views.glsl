// How a light sees the scene.
#ifndef VOLGI_MAP_VIEWS_GLSL
#define VOLGI_MAP_VIEWS_GLSL
#include "screen/visibility/area_maps/virtual_area_light.shared.h"
#include "screen/visibility/imperfect/light_map.shared.h"

// A unit vector across a unit normal, the same for all who ask.
vec3 right_of(vec3 normal) {
  vec3 away = abs(normal.x) < 0.7 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0);
  return normalize(away - normal * dot(away, normal));
}

VirtualAreaLight map_view(vec3 position, vec3 normal) {
  VirtualAreaLight view;
  view.position = position;
  view.area_m2 = 0.0;
  view.normal = normal;
  view.size_m = 0.0;
  view.right = right_of(normal);
  view.light_count = 1;
  view.flux = vec3(0.0);
  view.first_light = 0;
  return view;
}

#endif
