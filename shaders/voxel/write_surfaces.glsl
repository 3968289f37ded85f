// The surfaces nearest to the two cells of each face write what the cells see. Comes after keys.glsl and
// visit_faces.glsl.
#include "voxel/slots.shared.h"
#include "voxel/surfaces.glsl"

layout(std430, binding = KEY_LOW_PLACE * FAMILIES) readonly buffer KeyLow { uint at[]; } key_low[FAMILIES];
layout(std430, binding = KEY_HIGH_PLACE * FAMILIES) readonly buffer KeyHigh { uint at[]; } key_high[FAMILIES];
layout(std430, binding = ENTRIES_PLACE * FAMILIES) readonly buffer Entries { uint at[]; } entries[FAMILIES];
layout(std430, binding = SURFACES_PLACE * FAMILIES) writeonly buffer Surfaces { Surface at[]; } surfaces[FAMILIES];

// Every line of the triangle on this face: the keys say which of them won.
void add_line(inout Run run, Lines lines, ivec2 line, dvec3 edges, double plane, int segment) {}

Surface surface_of(int axis, Lines lines, ivec3 place, uint key, bool upper) {
  int number = key_line(key);
  vec3 weights = weights_at(lines, edges_at(lines, 3 * place.yz + ivec2(number % 3, number / 3)));
  // Rounding may tilt what the axis runs along to the other side.
  vec3 rounded = vec3(cross(dvec3(v_vertex[1] - v_vertex[0]), dvec3(v_vertex[2] - v_vertex[0])));
  vec3 normal = v_normal[axis] * rounded[axis] > 0.0 ? v_normal : normalize(rounded);
  bool front = (normal[axis] > 0.0) == upper;
  float centre_depth = float(depth_at(lines, plane_at(lines, 3 * place.yz + 1)));
  Surface s;
  s.normal = front ? normal : -normal;
  s.depth = clamp(centre_depth, -4096.0, 4096.0);  // off the centre line the true plane may pass the centre far away
  s.albedo = albedo_alpha_at(weights).rgb;
  s.front = front ? 1 : 0;
  s.radiosity = vec3(0.0);
  if (front || material_double_sided != 0) {
    s.radiosity = 3.14159265 * material_emission(uv0_at(weights), uv1_at(weights));
  }
  s.area_m2 = 0.0;
  return s;
}

void end_face(int axis, Lines lines, Run run) {
  int family = FAMILIES == 1 ? 0 : axis;
  int face = face_offset(axis, run.place);
  uint entry = entries[family].at[face];
  if (entry == NO_ENTRY) return;
  uint low = key_low[family].at[face];
  uint high = key_high[family].at[face];
  if (key_of_triangle(low, v_triangle)) surfaces[family].at[2u * entry] = surface_of(axis, lines, run.place, low, false);
  if (key_of_triangle(high, v_triangle)) {
    surfaces[family].at[2u * entry + 1u] = surface_of(axis, lines, run.place, high, true);
  }
}
