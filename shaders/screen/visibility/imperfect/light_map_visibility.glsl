// Share of a virtual light that reaches a point, by the light's own map. Lights without one are seen from everywhere.
#ifndef VOLGI_LIGHT_MAP_VISIBILITY_GLSL
#define VOLGI_LIGHT_MAP_VISIBILITY_GLSL
#include "screen/visibility/area_maps/area_light_shadow.glsl"
#include "screen/visibility/imperfect/map_views.glsl"

uniform int map_lights;  // of all, with maps or without
uniform int map_mapped;  // of those that have maps
uniform int map_sides;   // maps of each: 1 ahead, 2 ahead and back
uniform int map_texels;  // on a side of a map
uniform int map_tiles;   // maps on a side of a layer

// @param normal  of the receiver, geometric, towards the viewer.
float light_map_visibility(int light, vec3 light_position, vec3 light_normal, vec3 position, vec3 normal) {
  int map = map_of_light(light, map_lights, map_mapped);
  if (map < 0) return 1.0;
  map *= map_sides;
  if (map_sides == 2 && dot(position - light_position, light_normal) < 0.0) {
    ++map;
    light_normal = -light_normal;
  }
  int of_layer = map_tiles * map_tiles;
  ShadowReceiver receiver = shadow_receiver(map / of_layer, map_view(light_position, light_normal), position, normal);
  if (receiver.position.z <= 0.0) return 0.0;
  return map_visibility(receiver, map_texels, ivec2(map % of_layer % map_tiles, map % of_layer / map_tiles) * map_texels);
}

#endif
