#version 450 core
// Virtual lights from the patches of one light at a depth. Every one of depth 0, or (BY_SIZE) as Nichols 2010, §4.2.3
// has it: those in which there is no discontinuity although there is one in what they are a part of. Those have the
// place of their first finest part: a place for every finest patch, most of them without light.
#include "screen/lights/patches/light_patches.glsl"
#include "shared/group_sizes.shared.h"
#include "shared/virtual_light.shared.h"

layout(local_size_x = LINEAR_GROUP) in;
layout(std430, binding = CHOSEN_PATCHES_SLOT) writeonly buffer Chosen { VirtualLight chosen[]; };
uniform int deepest;

bool is_chosen(int place) {
#ifdef BY_SIZE
  if (depth < deepest && is_discontinuous(ranges[place])) return false;
  if (depth == 0) return true;
  int whole = first_of_depth(root_count, depth - 1) + (place - first_of_depth(root_count, depth)) / 4;
  return is_discontinuous(ranges[whole]);
#else
  return true;
#endif
}

void main() {
  int index = int(global_index());
  if (index >= patches_of_light()) return;
  int place = place_of(index);
  if (!is_chosen(place)) return;
  LightPatch p = patches[place];
  int slot = ((first_root << (2 * depth)) + index) << (2 * (deepest - depth));
  chosen[slot] = VirtualLight(p.position, p.area_m2, p.normal, VIRTUAL_LIGHT_REFLECTED, p.flux, light);
}
