// Beginning of a list that the GPU makes and works off: screen/base/work_list.h and work_list.glsl.
#ifndef VOLGI_WORK_LIST_SHARED_H
#define VOLGI_WORK_LIST_SHARED_H
#include "shared/base.shared.h"
SHARED_BEGIN

// The arguments of an indirect dispatch, {0, 1, 1} while the list is empty, and its length.
struct WorkListHead {
  uint groups_x, groups_y, groups_z;
  uint count;
};
#ifdef __cplusplus
static_assert(sizeof(WorkListHead) == 16);
#endif

SHARED_END
#endif
