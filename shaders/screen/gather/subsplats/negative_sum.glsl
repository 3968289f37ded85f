// What negative lights take away at a subsplat, as every gather has it.
#include "screen/visibility/negative/negative_lights_block.glsl"
#include "screen/visibility/negative/negative_sum.glsl"
uniform int negative_count;

vec3 sum_of_lights(Receiver at) { return sum_of_negative_lights(at.position, at.normal, negative_count); }
