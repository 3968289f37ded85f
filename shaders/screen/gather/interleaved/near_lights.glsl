// Tiles of pixels, and the list of those that lights are near.
#ifndef VOLGI_NEAR_LIGHTS_GLSL
#define VOLGI_NEAR_LIGHTS_GLSL
#include "screen/gather/interleaved/near_tiles.shared.h"
#include "screen/gather/interleaved/slots.shared.h"
#include "shared/near_light.shared.h"
#include "screen/base/work_list.glsl"

// A group a tile, in no order.
layout(std430, binding = NEAR_TILES_SLOT) buffer TileList { WorkListHead head; uint listed_tiles[]; };
layout(std430, binding = NEAR_LIGHTS_SLOT) readonly buffer NearLights { NearLight near_lights[]; };
layout(std430, binding = TILE_MASKS_SLOT) buffer Masks { uint masks[]; };  // 32 lights a word, tile after tile
uniform ivec2 tiles;
uniform int words;   // of a tile's mask
uniform float zone;  // areas of a light
uniform int apart;   // 1: sub-lights have a share by their own places (irradiance_of_sublights_apart())

// Squared distance from the light at which it has the last of its sub-lights' light.
float reach_squared(NearLight light) {
  float reach = sqrt(2.0 * zone * light.area_m2) + light.spread_m;
  return apart != 0 ? reach * reach : 2.0 * zone * light.area_m2;
}

#endif
