#version 450 core
// One transport order of the `ordinates` scheme: discrete ordinates (docs/theory.md#ordinates). The flow of the
// directions of one octant is ordered, so one sweep over the cells, upwind cells first, solves void, blocked and partly
// transmitting faces to rounding.
//
// A work group takes a block of 8^3 cells of all octants, a dispatch one diagonal of blocks: these do not depend on each
// other. An invocation has one band of four directions of an octant and walks through the block's cells, so that no two
// invocations wait for each other. It takes tiles of 4 x 4 cells along z; what passes between the cells of a tile stays
// in registers, what passes between tiles lies in one plane of the grid an axis, read and written in place.
// Set by the program: QUADS = 4
// Set by the program: CHARACTERISTIC = 1
#include "propagation/side_texel.glsl"
#include "propagation/slots.shared.h"
#include "propagation/sweep.shared.h"
#include "voxel/grid_block.glsl"

layout(local_size_x = 3 * QUADS, local_size_y = 8) in;  // lane: band and four directions; octant
// Of four directions; a is an upwind, b a downwind face's axis.
struct QuadShares {
  vec4 emitted[3];  // of what a side on face a sends (OrdinateSet::emitted_share)
  // Step: of a cell's power through face b. Characteristic (SC1): of what comes in by face a through face b, 3 a + b.
  vec4 downwind[CHARACTERISTIC != 0 ? 9 : 3];
};
layout(std430, binding = SHARES_SLOT) readonly buffer Shares { QuadShares shares[QUADS]; };
// What comes in from outside through a face of the rim [W], by octant, lane and axis.
layout(std430, binding = INFLOW_SLOT) readonly buffer Inflow { vec4 inflow[]; };
uniform int streams_in;
layout(binding = CELL_WORD_UNIT) uniform usampler3D cell_word;    // (first side << 6) | faces (prepare_sweep)
layout(binding = SIDE_LIGHT_UNIT) uniform sampler2D side_light;   // rgb sent [W], a: 1 - tau
layout(binding = BLOCK_LIST_UNIT) uniform usampler2D block_list;  // of all diagonals: x | y << 8 | z << 16
// What leaves cells through downwind faces [W], by octant and lane, then by the face's place: (y,z), (x,z), (x,y).
layout(binding = FACES_IMAGE, rgba32f) uniform restrict image3D x_faces;
layout(binding = FACES_IMAGE + 1, rgba32f) uniform restrict image3D y_faces;
layout(binding = FACES_IMAGE + 2, rgba32f) uniform restrict image3D z_faces;
layout(binding = ARRIVED_IMAGE, r32f) uniform restrict writeonly image2D arrived;  // side_texel.glsl
uniform int first_block;                                                           // of the diagonal, in block_list

const int BLOCK = SWEEP_BLOCK;
const int TILE = 4;

// The invocation's own.
int lane = int(gl_LocalInvocationID.x), octant = int(gl_LocalInvocationID.y);
int band = lane / QUADS;
QuadShares own = shares[lane % QUADS];
vec4 from_outside[3] = vec4[3](vec4(0.0), vec4(0.0), vec4(0.0));
// Flow coordinates grow along the octant's flow: cell = cell_of_flow_0 + cell_step * flow.
ivec3 positive = ivec3(octant & 1, (octant >> 1) & 1, octant >> 2);
ivec3 cell_of_flow_0 = (1 - positive) * (grid.cells - 1), cell_step = 2 * positive - 1;
// Bits of a cell's faces: of axis a 2 a where the flow is positive, else 2 a + 1.
uint upwind_faces = (2u >> positive.x) | (8u >> positive.y) | (32u >> positive.z);

int side_of(uint word, int face) { return int(word >> 6) + bitCount(word & ((1u << face) - 1u)); }

// Sides on upwind faces: what they send, and what they let through.
void enter(uint word, inout vec4 x, inout vec4 y, inout vec4 z) {
  for (uint rest = word & upwind_faces; rest != 0u; rest &= rest - 1u) {
    int face = findLSB(rest);
    vec4 side = texelFetch(side_light, side_texel(side_of(word, face)), 0);
    float sent = side[band];
    if (face < 2) x = side.a * x + sent * own.emitted[0];
    else if (face < 4) y = side.a * y + sent * own.emitted[1];
    else z = side.a * z + sent * own.emitted[2];
  }
}

// What reaches sides on downwind faces; the sides' share is taken in collect_octants.
void leave(uint word, vec4 x, vec4 y, vec4 z) {
  for (uint rest = word & 63u & ~upwind_faces; rest != 0u; rest &= rest - 1u) {
    int face = findLSB(rest);
    int axis = face >> 1;
    vec4 power = axis == 0 ? x : axis == 1 ? y : z;
    float sum = (power.x + power.y) + (power.z + power.w);
    imageStore(arrived, arrived_texel(side_of(word, face), entry_of_octant(octant, axis), lane, 3 * QUADS), vec4(sum));
  }
}

// From what comes in through a cell's upwind faces to what goes on through its downwind faces.
void carry_cell(ivec3 flow, inout vec4 x, inout vec4 y, inout vec4 z) {
  uint word = texelFetch(cell_word, cell_of_flow_0 + cell_step * flow, 0).x;
  if (any(greaterThanEqual(flow, grid.cells))) word = 0u;
  enter(word, x, y, z);
#if CHARACTERISTIC
  vec4 out_x = own.downwind[0] * x + own.downwind[3] * y + own.downwind[6] * z;
  vec4 out_y = own.downwind[1] * x + own.downwind[4] * y + own.downwind[7] * z;
  vec4 out_z = own.downwind[2] * x + own.downwind[5] * y + own.downwind[8] * z;
#else
  vec4 power = x + y + z;
  vec4 out_x = own.downwind[0] * power;
  vec4 out_y = own.downwind[1] * power;
  vec4 out_z = own.downwind[2] * power;
#endif
  leave(word, out_x, out_y, out_z);
  x = out_x;
  y = out_y;
  z = out_z;
}

// Place of a face in its plane.
ivec3 in_plane(int u, int v) { return ivec3(octant * 3 * QUADS + lane, u, v); }
// A macro, because a parameter of a function has no image format.
#define COME_IN(faces, axis, u, v, inside) ((inside) ? imageLoad(faces, in_plane(u, v)) : from_outside[axis])

// Four cells along x. Indices are literal wherever registers are meant.
void carry_row(ivec3 first, inout vec4 y[TILE], inout vec4 z[TILE * TILE]) {
  vec4 x = COME_IN(x_faces, 0, first.y, first.z, first.x > 0);
  carry_cell(first, x, y[0], z[0]);
  carry_cell(first + ivec3(1, 0, 0), x, y[1], z[1]);
  carry_cell(first + ivec3(2, 0, 0), x, y[2], z[2]);
  carry_cell(first + ivec3(3, 0, 0), x, y[3], z[3]);
  imageStore(x_faces, in_plane(first.y, first.z), x);
}

// The next row's four become the first.
void turn_rows(inout vec4 z[TILE * TILE]) {
  vec4 done[TILE];
  for (int i = 0; i < TILE; ++i) done[i] = z[i];
  for (int i = 0; i < TILE * (TILE - 1); ++i) z[i] = z[i + TILE];
  for (int i = 0; i < TILE; ++i) z[TILE * (TILE - 1) + i] = done[i];
}

void carry_tile(ivec3 first, int end_z) {
  vec4 through_y[TILE], through_z[TILE * TILE];  // what comes into the next cells [W]
  for (int i = 0; i < TILE * TILE; ++i)
    through_z[i] = COME_IN(z_faces, 2, first.x + i % TILE, first.y + i / TILE, first.z > 0);
  for (int z = first.z; z < end_z; ++z) {
    for (int x = 0; x < TILE; ++x) through_y[x] = COME_IN(y_faces, 1, first.x + x, z, first.y > 0);
    for (int y = 0; y < TILE; ++y) {
      carry_row(ivec3(first.x, first.y + y, z), through_y, through_z);
      turn_rows(through_z);
    }
    for (int x = 0; x < TILE; ++x) imageStore(y_faces, in_plane(first.x + x, z), through_y[x]);
  }
  for (int i = 0; i < TILE * TILE; ++i)
    imageStore(z_faces, in_plane(first.x + i % TILE, first.y + i / TILE), through_z[i]);
}

void main() {
  if (streams_in != 0) {
    int at = 3 * (octant * 3 * QUADS + lane);
    from_outside = vec4[3](inflow[at], inflow[at + 1], inflow[at + 2]);
  }
  int n = first_block + int(gl_WorkGroupID.x);
  uint block = texelFetch(block_list, ivec2(n & ((1 << DIAGONAL_ROW_BITS) - 1), n >> DIAGONAL_ROW_BITS), 0).x;
  ivec3 first = BLOCK * ivec3(block & 255u, (block >> 8) & 255u, block >> 16);
  ivec3 end = min(first + BLOCK, grid.cells);
  for (int y = first.y; y < end.y; y += TILE) {
    for (int x = first.x; x < end.x; x += TILE) carry_tile(ivec3(x, y, first.z), end.z);
  }
}
