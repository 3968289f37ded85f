// Lists that the GPU makes and works off by an indirect dispatch.
#ifndef VOLGI_WORK_LIST_GLSL
#define VOLGI_WORK_LIST_GLSL
#include "shared/global_index.shared.h"

// Beginning of a list: the arguments of the dispatch, {0, 1, 1} while it is empty, and the length.
struct WorkListHead {
  uint groups_x, groups_y, groups_z;
  uint count;
};

// Makes room for one more, at `slot`, and for a group of threads to every `a_group` of them. A macro, because heads in
// buffers cannot be handed to functions.
#define TAKE_SLOT(head, a_group, slot)                                                \
  slot = atomicAdd(head.count, 1u);                                                   \
  if (slot % a_group == 0u) {                                                         \
    if (slot / a_group < uint(GROUPS_A_ROW)) atomicAdd(head.groups_x, 1u);            \
    else if (slot / a_group % uint(GROUPS_A_ROW) == 0u) atomicAdd(head.groups_y, 1u); \
  }

#endif
