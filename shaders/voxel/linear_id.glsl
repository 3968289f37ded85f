// Number of an invocation and its group in a dispatch that is folded to stay within 65535 groups along x.
uint linear_group() { return gl_WorkGroupID.x + gl_NumWorkGroups.x * gl_WorkGroupID.y; }
uint linear_id() { return linear_group() * gl_WorkGroupSize.x + gl_LocalInvocationID.x; }
