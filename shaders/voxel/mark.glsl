// Marks what a surface does to faces: which parts of their fine lines it blocks, and the keys of the nearest surfaces. Comes
// after keys.glsl and visit_faces.glsl.
#include "voxel/slots.shared.h"

// Keys of the surface nearest to the cell below the face, and above.
layout(std430, binding = KEY_LOW_PLACE * FAMILIES) buffer KeyLow { uint at[]; } key_low[FAMILIES];
layout(std430, binding = KEY_HIGH_PLACE * FAMILIES) buffer KeyHigh { uint at[]; } key_high[FAMILIES];
layout(std430, binding = BLOCKED_PLACE * FAMILIES) buffer Blocked { uint at[]; } blocked[FAMILIES];  // 27 bits
#ifdef ALPHA
// Run.haze of the centre line.
layout(std430, binding = HAZE_PLACE * FAMILIES) buffer Haze { uint at[]; } haze[FAMILIES];
#endif

void add_line(inout Run run, Lines lines, ivec2 line, dvec3 edges, double plane, int segment) {
  int number = line.x % 3 + 3 * (line.y % 3);
  float stopped = stopped_at(weights_at(lines, edges));
  if (stopped <= 0.0) return;
  if (stopped >= 0.999) {
    run.blocked |= 1u << (9 * (segment % 3) + number);
  } else if (number == 4) {
    run.haze += max(uint(-log(1.0 - stopped) * 65536.0 + 0.5), 1u);  // 0 would be no side
  }
  uint low, high;
  make_keys(float(depth_at(lines, plane)) - float(run.place.x) + 0.5, number, v_triangle, low, high);
  run.low = min(run.low, low);
  run.high = min(run.high, high);
}

void end_face(int axis, Lines lines, Run run) {
  int family = FAMILIES == 1 ? 0 : axis;
  int face = face_offset(axis, run.place);
  if (run.low == 0xffffffffu) return;  // cut out
  atomicMin(key_low[family].at[face], run.low);
  atomicMin(key_high[family].at[face], run.high);
  if (run.blocked != 0u) atomicOr(blocked[family].at[face], run.blocked);
#ifdef ALPHA
  if (run.haze != 0u) atomicAdd(haze[family].at[face], run.haze);
#endif
}
