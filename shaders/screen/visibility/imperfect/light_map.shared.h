// Which virtual lights have maps.
#ifndef VOLGI_LIGHT_MAP_SHARED_H
#define VOLGI_LIGHT_MAP_SHARED_H
#include "shared/base.shared.h"
SHARED_BEGIN

// Of `lights`, `mapped` have maps, evenly spread in the list; their product is under 2^32.
// @return the light's place among those that have one, or -1.
SHARED_FUNCTION int map_of_light(int light, int lights, int mapped) {
  uint before = uint(light) * uint(mapped) / uint(lights);
  uint after = uint(light + 1) * uint(mapped) / uint(lights);
  return after > before ? int(before) : -1;
}
SHARED_FUNCTION int light_of_map(int map, int lights, int mapped) {
  return int((uint(map + 1) * uint(lights) + uint(mapped) - 1u) / uint(mapped)) - 1;
}

SHARED_END
#endif
