#version 450 core
// Radiance that sides' powers make in free space by the `ordinates` scheme, read out for export and tests: the sweep of
// sweep.comp.glsl once more, where an invocation holds all directions of a cell. A dispatch takes one diagonal i+j+k of an
// octant: its cells do not depend on each other, and only the diagonal before is kept. Octants follow one another, and
// each adds to the cells' radiance.
//
// Powers are packed: value 3 d + band of the octant's direction d, four values a texel, so texel k begins with band k % 3.
// Step keeps a cell's power of each direction; characteristic (SC1) what leaves through each of its three downwind faces.
// Set by the program: TEXELS = 3
// Set by the program: CHARACTERISTIC = 1
#include "propagation/side_texel.glsl"
#include "propagation/slots.shared.h"
#include "propagation/sweep.shared.h"
#include "shared/group_sizes.shared.h"
#include "voxel/grid_block.glsl"

layout(local_size_x = LINEAR_GROUP) in;
// By texel; a is an upwind, b a downwind face's axis.
layout(std140, binding = SHARES_BLOCK) uniform SharesBlock {
  vec4 emitted_share[3 * TEXELS];  // of what a side on face a sends (OrdinateSet::emitted_share): 3 k + a
  // Step: of a cell's power through face b: 3 k + b. Characteristic: of what came in through face a: 9 k + 3 a + b.
  vec4 downwind_share[(CHARACTERISTIC != 0 ? 9 : 3) * TEXELS];
  vec4 radiance_weight[3 * TEXELS];  // radiance_per_watt of what comes in through face a: 3 k + a
  vec4 direction[3 * TEXELS];        // its component on axis a: 3 k + a
};
// Column (i,j); layers by texel, downwind face.
layout(binding = BEFORE_PLANE_UNIT) uniform sampler2DArray before_plane;
layout(binding = CELL_WORD_UNIT) uniform usampler3D cell_word;    // (first side << 6) | faces (prepare_sweep)
layout(binding = SIDE_LIGHT_UNIT) uniform sampler2D side_light;   // rgb sent [W], a: 1 - tau
layout(binding = COLUMN_MAP_UNIT) uniform usampler2D column_map;  // of all diagonals' cells: i + (j << 16)
layout(binding = THIS_PLANE_IMAGE, rgba32f) uniform restrict writeonly image2DArray this_plane;
layout(binding = SWEEP_RADIANCE_IMAGE, rgba32f) uniform restrict image3D radiance_sh;  // four coefficients stacked in z
uniform int diagonal;
uniform int first_cell;  // of the diagonal, in column_map
uniform int cell_count;
uniform int octant;

const int FACES = CHARACTERISTIC != 0 ? 3 : 1;

struct Light {
  bool at_sides;  // the cell has sides: the next two count
  vec3 sent[3];   // by the sides on the upwind faces [W]
  vec3 pass;      // share that comes through each upwind face
  vec3 sh[4];     // of the octant's light, in the octant's own axes
};

struct From {  // columns that light comes from
  ivec2 x, y, z;
  int layer;
};

vec4 packed_bands(vec3 rgb, int first) { return first == 0 ? rgb.rgbr : first == 1 ? rgb.gbrg : rgb.brgb; }
vec3 summed_bands(vec4 t, int first) {
  vec3 sum = vec3(t.x + t.w, t.yz);
  return first == 0 ? sum.xyz : first == 1 ? sum.zxy : sum.yzx;
}

int side_of(uint word, int face) { return int(word >> 6) + bitCount(word & ((1u << face) - 1u)); }
bool word_has_side(uint word, int face) { return ((word >> face) & 1u) != 0u; }

// The upwind face of `axis`: what a side there sends, and what it lets through.
void enter(uint word, int axis, int face, inout Light light) {
  vec4 side = texelFetch(side_light, side_texel(side_of(word, face)), 0);
  light.sent[axis] = word_has_side(word, face) ? side.rgb : vec3(0.0);
  if (word_has_side(word, face)) light.pass[axis] *= side.a;
}

void add_radiance(int k, int band, vec4 in_x, vec4 in_y, vec4 in_z, inout Light light) {
  vec4 q = radiance_weight[3 * k] * in_x + radiance_weight[3 * k + 1] * in_y + radiance_weight[3 * k + 2] * in_z;
  light.sh[0] += summed_bands(q, band);
  light.sh[1] += summed_bands(q * direction[3 * k + 1], band);
  light.sh[2] += summed_bands(q * direction[3 * k + 2], band);
  light.sh[3] += summed_bands(q * direction[3 * k], band);
}

// Texel k of the cell, which begins with `band`. Indices are literal wherever this is called: a driver may gather a
// uniform by computed index lane by lane (llvmpipe: 2.5 times the whole sweep's time).
void carry_texel(int k, int band, From from, inout Light light) {
  int layer = from.layer + k * FACES;
#if CHARACTERISTIC
  vec4 in_x = light.pass.x * texelFetch(before_plane, ivec3(from.x, layer), 0);
  vec4 in_y = light.pass.y * texelFetch(before_plane, ivec3(from.y, layer + 1), 0);
  vec4 in_z = light.pass.z * texelFetch(before_plane, ivec3(from.z, layer + 2), 0);
#else
  vec4 in_x = light.pass.x * downwind_share[3 * k] * texelFetch(before_plane, ivec3(from.x, layer), 0);
  vec4 in_y = light.pass.y * downwind_share[3 * k + 1] * texelFetch(before_plane, ivec3(from.y, layer), 0);
  vec4 in_z = light.pass.z * downwind_share[3 * k + 2] * texelFetch(before_plane, ivec3(from.z, layer), 0);
#endif
  if (light.at_sides) {
    in_x += emitted_share[3 * k] * packed_bands(light.sent[0], band);
    in_y += emitted_share[3 * k + 1] * packed_bands(light.sent[1], band);
    in_z += emitted_share[3 * k + 2] * packed_bands(light.sent[2], band);
  }
  add_radiance(k, band, in_x, in_y, in_z, light);
#if CHARACTERISTIC
  vec4 out_x = downwind_share[9 * k] * in_x + downwind_share[9 * k + 3] * in_y + downwind_share[9 * k + 6] * in_z;
  vec4 out_y = downwind_share[9 * k + 1] * in_x + downwind_share[9 * k + 4] * in_y + downwind_share[9 * k + 7] * in_z;
  vec4 out_z = downwind_share[9 * k + 2] * in_x + downwind_share[9 * k + 5] * in_y + downwind_share[9 * k + 8] * in_z;
  imageStore(this_plane, ivec3(from.z, layer), out_x);
  imageStore(this_plane, ivec3(from.z, layer + 1), out_y);
  imageStore(this_plane, ivec3(from.z, layer + 2), out_z);
#else
  imageStore(this_plane, ivec3(from.z, layer), in_x + in_y + in_z);
#endif
}

void carry_texels(From from, inout Light light) {
#if TEXELS > 0
  carry_texel(0, 0, from, light);
#endif
#if TEXELS > 1
  carry_texel(1, 1, from, light);
#endif
#if TEXELS > 2
  carry_texel(2, 2, from, light);
#endif
#if TEXELS > 3
  carry_texel(3, 0, from, light);
#endif
#if TEXELS > 4
  carry_texel(4, 1, from, light);
#endif
#if TEXELS > 5
  carry_texel(5, 2, from, light);
#endif
#if TEXELS > 6
  carry_texel(6, 0, from, light);
#endif
#if TEXELS > 7
  carry_texel(7, 1, from, light);
#endif
#if TEXELS > 8
  carry_texel(8, 2, from, light);
#endif
#if TEXELS > 9
  carry_texel(9, 0, from, light);
#endif
#if TEXELS > 10
  carry_texel(10, 1, from, light);
#endif
#if TEXELS > 11
  carry_texel(11, 2, from, light);
#endif
}

// Real, orthonormal, order 00, 1-1 (y), 10 (z), 11 (x).
void store_radiance(ivec3 cell, vec3 octant_sign, Light light) {
  vec4 y = vec4(0.28209479, 0.48860251 * octant_sign.yzx);
  for (int i = 0; i < 4; ++i) {
    ivec3 texel = cell + ivec3(0, 0, i * grid.cells.z);
    imageStore(radiance_sh, texel, imageLoad(radiance_sh, texel) + vec4(y[i] * light.sh[i], 0.0));
  }
}

void main() {
  int n = int(gl_GlobalInvocationID.x);
  if (n >= cell_count) return;
  n += first_cell;
  int column = int(texelFetch(column_map, ivec2(n & ((1 << DIAGONAL_ROW_BITS) - 1), n >> DIAGONAL_ROW_BITS), 0).x);
  ivec3 flow = ivec3(column & 0xffff, column >> 16, 0);
  flow.z = diagonal - flow.x - flow.y;
  ivec3 positive = ivec3(octant & 1, (octant >> 1) & 1, octant >> 2);
  ivec3 cell = positive * flow + (1 - positive) * (grid.cells - 1 - flow);
  uint word = texelFetch(cell_word, cell, 0).x;

  Light light;
  light.at_sides = (word & 63u) != 0u;
  light.pass = vec3(greaterThan(flow, ivec3(0)));
  for (int axis = 0; axis < 3; ++axis) light.sent[axis] = vec3(0.0);
  for (int i = 0; i < 4; ++i) light.sh[i] = vec3(0.0);
  if (light.at_sides) {
    enter(word, 0, 1 - positive.x, light);
    enter(word, 1, 3 - positive.y, light);
    enter(word, 2, 5 - positive.z, light);
  }
  From from = From(ivec2(max(flow.x - 1, 0), flow.y), ivec2(flow.x, max(flow.y - 1, 0)), flow.xy, 0);
  carry_texels(from, light);
  store_radiance(cell, vec3(2 * positive - 1), light);
}
