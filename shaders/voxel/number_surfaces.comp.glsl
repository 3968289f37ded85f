#version 450 core
// Gives each face of one axis that some surface crosses a place in the list of surfaces. Places come in any order: what is
// seen of them does not depend on it.
#include "shared/global_index.shared.h"
#include "voxel/groups.shared.h"
#include "voxel/slots.shared.h"
#include "voxel/surfaces.glsl"

layout(local_size_x = VOXEL_GROUP) in;
layout(std430, binding = NUMBER_KEY_LOW_SLOT) readonly buffer KeyLow { uint key_low[]; };
layout(std430, binding = NUMBER_ENTRIES_SLOT) writeonly buffer Entries { uint entries[]; };
layout(std430, binding = WANTED_SLOT) buffer Wanted { uint wanted[4]; };  // entries of each axis, sides
uniform int axis;
uniform uint capacity;  // of the list; faces beyond it are black in this frame

shared uint group_count;
shared uint group_first;

void main() {
  uint face = global_index();
  bool crossed = face < uint(key_low.length()) && key_low[face] != 0xffffffffu;
  if (gl_LocalInvocationID.x == 0u) group_count = 0u;
  barrier();
  uint place = crossed ? atomicAdd(group_count, 1u) : 0u;
  barrier();
  if (gl_LocalInvocationID.x == 0u && group_count > 0u) group_first = atomicAdd(wanted[axis], group_count);
  barrier();
  if (face >= uint(entries.length())) return;
  entries[face] = crossed && group_first + place < capacity ? group_first + place : NO_ENTRY;
}
