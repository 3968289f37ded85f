#version 450 core
// Deposits the light that pieces of emissive surfaces send (voxel/emitter_pieces.h).
#include "propagation/slots.shared.h"
#include "shared/global_index.shared.h"
#include "propagation/deposit.glsl"
#include "shared/group_sizes.shared.h"

struct Piece {
  vec4 position;
  vec4 normal;
  vec4 flux;
};

layout(local_size_x = LINEAR_GROUP) in;
layout(std430, binding = PIECES_SLOT) readonly buffer Pieces { Piece pieces[]; };
uniform int piece_count;

void main() {
  int i = int(global_index());
  if (i >= piece_count) return;
  deposit(pieces[i].position.xyz, pieces[i].normal.xyz, pieces[i].flux.rgb);
}
