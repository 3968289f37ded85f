#version 450 core
// Every cluster's center: mean position and mean normal of its lights. A cluster that lost all of them stays where it
// was. One work group a cluster.
#define CLUSTERS_AS_UVEC4
#define GROUP 32
#include "screen/visibility/area_maps/virtual_area_lights.glsl"
#include "screen/visibility/area_maps/virtual_area_lights_reduce.glsl"

// Which of 32 lights are the cluster's: bit 4 s + c for light c of four (four + s GROUP).
uint members(uint cluster, int four, int fours) {
  uint found = 0u;
  for (int s = 0; s < 8; ++s) {
    if (four + s * GROUP >= fours) break;
    uvec4 bits = uvec4(equal(clusters_as_uvec4[four + s * GROUP], uvec4(cluster)));
    found |= (bits.x | bits.y << 1 | bits.z << 2 | bits.w << 3) << (4 * s);
  }
  return found;
}

// Bits first and lights then, because most lights are another cluster's.
void main() {
  if (moved[iteration] == 0u) return;
  uint cluster = gl_WorkGroupID.x;
  int fours = (light_count + 3) / 4;
  vec4 position = vec4(0.0);  // and how many
  vec3 normal = vec3(0.0);
  for (int four = int(gl_LocalInvocationIndex); four < fours; four += 8 * GROUP) {
    for (uint found = members(cluster, four, fours); found != 0u; found &= found - 1u) {
      int bit = findLSB(found);
      int i = 4 * (four + (bit >> 2) * GROUP) + (bit & 3);
      position += vec4(lights[i].position, 1.0);
      normal += lights[i].normal;
    }
  }
  position = sum_of_group(position);
  normal = sum_of_group(vec4(normal, 0.0)).xyz;
  if (gl_LocalInvocationIndex != 0u || position.w == 0.0) return;
  centers[cluster].position = position.xyz / position.w;
  float sum = length(normal);
  if (sum > 1e-3 * position.w) centers[cluster].normal = normal / sum;  // else normals cancel
}
