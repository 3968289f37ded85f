// Lists that the GPU makes and works off by an indirect dispatch.
#ifndef VOLGI_WORK_LIST_GLSL
#define VOLGI_WORK_LIST_GLSL
#include "screen/base/work_list.shared.h"
#include "shared/global_index.shared.h"

// Appends one entry, at `slot`, and a group of threads for every `per_group` entries. A macro, because heads in
// buffers cannot be handed to functions.
#define APPEND_TO_LIST(head, per_group, slot)                                             \
  slot = atomicAdd(head.count, 1u);                                                       \
  if (slot % per_group == 0u) {                                                           \
    if (slot / per_group < uint(GROUPS_PER_ROW)) atomicAdd(head.groups_x, 1u);            \
    else if (slot / per_group % uint(GROUPS_PER_ROW) == 0u) atomicAdd(head.groups_y, 1u); \
  }

#endif
