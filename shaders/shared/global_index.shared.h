// Numbers of groups and invocations in a one-dimensional dispatch. GL promises no more than 65535 groups along an axis:
// gl::dispatch_linear and work lists (screen/base/work_list.glsl) go on in further rows.
#ifndef VOLGI_GLOBAL_INDEX_SHARED_H
#define VOLGI_GLOBAL_INDEX_SHARED_H
#include "shared/base.shared.h"

#define GROUPS_PER_ROW 32768

#ifndef __cplusplus
uint group_index() { return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x; }
// A macro, because the size of a group is known only behind its layout.
#define global_index() \
  (group_index() * (gl_WorkGroupSize.x * gl_WorkGroupSize.y * gl_WorkGroupSize.z) + gl_LocalInvocationIndex)
#endif

#endif
