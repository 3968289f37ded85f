#version 450 core
// The same step (refine.geom.glsl) by lists: subsplats of `level` to the list of the next one, or to that of those that
// are done.
#include "screen/base/work_list.glsl"
#include "screen/gather/subsplats/refinement_step.glsl"
#include "shared/group_sizes.shared.h"

layout(local_size_x = LINEAR_GROUP) in;
layout(std430, binding = SUBSPLATS_IN_SLOT) readonly buffer In { WorkListHead in_head; uvec2 in_list[]; };
layout(std430, binding = SUBSPLATS_OUT_SLOT) buffer Out { WorkListHead out_head; uvec2 out_list[]; };
layout(std430, binding = SUBSPLATS_DONE_SLOT) buffer Done { WorkListHead done_head; uvec2 done_list[]; };

void main() {
  uint index = global_index();
  if (index >= in_head.count) return;
  uvec2 listed = in_list[index];
  Subsplat s = unpack_subsplat(listed.x);
  uint slot;
  if (!has_surface(s)) return;
  if (!gives_way(s, listed.y)) {
    APPEND_TO_LIST(done_head, uint(LINEAR_GROUP), slot)
    done_list[slot] = listed;
    return;
  }
  for (int k = 0; k < 4; ++k) {
    Subsplat part = part_of(s, k);
    if (!is_there(part)) continue;
    if (part.level == finest_level) {
      APPEND_TO_LIST(done_head, uint(LINEAR_GROUP), slot)
      done_list[slot] = uvec2(pack_subsplat(part), listed.y);
    } else {
      APPEND_TO_LIST(out_head, uint(LINEAR_GROUP), slot)
      out_list[slot] = uvec2(pack_subsplat(part), listed.y);
    }
  }
}
