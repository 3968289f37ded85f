// What the `conservative` scheme needs of a lobe, for either order (docs/theory.md#conservative).
#include "propagation/lobes.glsl"

#if ORDER == 1
Lobe lobe_of_side(int face) { return side_lobe(face); }

// The part of a neighbour's lobe that crosses the face between: light that travels along `axis` by `sign`.
Lobe crossing(Lobe lobe, int axis, float sign) {
  int component = sh_component(axis);
  float axial = lobe[component];
  float power = FLUX_00 * lobe.x + sign * FLUX_01 * axial;
  vec4 moved = FLUX_ACROSS_11 * lobe;
  moved.x = power;
  moved[component] = sign * FLUX_10 * lobe.x + FLUX_11 * axial;
  return power > FLUX_MIN_SHARE * lobe.x ? moved : dark_lobe();
}

void keep_power(inout Lobe lobe) { lobe *= clamp_rescale(lobe); }
#else
Lobe lobe_of_side(int face) { return side_lobe_9(face); }

// Component of `mid` that is the product of two axes: xy, yz, (20), xz.
int product_component(int a, int b) { return a + b == 1 ? 0 : a + b == 3 ? 1 : 3; }

Lobe crossing(Lobe lobe, int axis, float sign) {
  int b = axis == 2 ? 0 : axis + 1;
  int c = axis == 0 ? 2 : axis - 1;
  float all = lobe.low.x;
  float axial = sign * lobe.low[sh_component(axis)];
  vec2 square = about_axis(vec2(lobe.mid.z, lobe.high), axis);
  float power = FLUX_00 * all + FLUX_01 * axial + FLUX_02 * square.x;
  if (power <= FLUX_MIN_SHARE * all) return dark_lobe();
  Lobe moved;
  moved.low[0] = power;
  moved.low[sh_component(axis)] = sign * (FLUX_10 * all + FLUX_11 * axial + FLUX_12 * square.x);
  for (int i = 0; i < 2; ++i) {
    int across = sh_component(i == 0 ? b : c);
    int leaning = product_component(axis, i == 0 ? b : c);
    moved.low[across] = FLUX_ACROSS_11 * lobe.low[across] + sign * FLUX_ACROSS_12 * lobe.mid[leaning];
    moved.mid[leaning] = sign * FLUX_ACROSS_21 * lobe.low[across] + FLUX_ACROSS_22 * lobe.mid[leaning];
  }
  moved.mid[product_component(b, c)] = FLUX_DIAGONAL * lobe.mid[product_component(b, c)];
  vec2 turned = from_axis(vec2(FLUX_20 * all + FLUX_21 * axial + FLUX_22 * square.x, FLUX_TWIN * square.y), axis);
  moved.mid[2] = turned.x;
  moved.high = turned.y;
  return moved;
}

void keep_power(inout Lobe lobe) {
  float factor = clamp_rescale(lobe);
  lobe = Lobe(factor * lobe.low, factor * lobe.mid, factor * lobe.high);
}
#endif

// Lobes are stored rescaled: then the clamped powers through the six faces sum to the power that they carry.
void keep_power(inout Lobes lobes) {
  keep_power(lobes.red);
  keep_power(lobes.green);
  keep_power(lobes.blue);
}

vec3 hit_power(Lobes lobes, int face) {
  return vec3(flux_passed(lobes.red, face), flux_passed(lobes.green, face), flux_passed(lobes.blue, face));
}
