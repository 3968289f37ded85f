#pragma once
// The inner loop of the `ordinates` scheme on the CPU: one block of 8^3 cells, one octant. Compiled several times for
// different instruction sets, so this header holds plain data only.
#include <cstdint>

namespace volgi::sweep {

constexpr int kBlockCells = 8;
constexpr int kBlockFace = kBlockCells * kBlockCells;
constexpr int kBlockVolume = kBlockFace * kBlockCells;
constexpr int kQuad = 4;   // floats of a power: r, g, b and one more
constexpr int kOctet = 8;  // lanes that are taken together at least
constexpr int kMaxOctets = 6;
constexpr int kMaxLanes = kMaxOctets * kOctet;

/// Lanes are directions x bands of an octant, in octets of two quads: r, g and b of one direction each. The fourth
/// lanes of three octets hold r, g and b of two more directions, where that saves an octet: 1, 3, 6, 10 and 16
/// directions take 1, 2, 3, 4 and 6 octets. Lanes without a direction have constants of zero and stay zero.
struct alignas(64) Constants {
  float share[3][3][kMaxLanes] = {};   // [in][out] of CellTransfer; the step kernel reads share[0] alone
  float emitted[3][kMaxLanes] = {};    // by axis, of a side's power
  float track[3][kMaxLanes] = {};      // radiance_per_watt by upwind axis [m^-2]
  float sh[4][kMaxLanes] = {};         // Y_00, Y_1-1, Y_10, Y_11 of the directions of the octant (+,+,+)
  float fold[kMaxOctets][kQuad] = {};  // which band the fourth lanes of an octet hold: one-hot, or zero
  int fourth[kMaxOctets] = {};         // the same as a number; 0 where they hold nothing
  int octets = 0;
};

/// Sides of a cell in 32 bits: a bit for each face that has one, and the first one's number in the block (0 ... 3071).
constexpr std::uint32_t pack_cell(std::uint32_t faces, std::uint32_t first) { return faces | (first << 6); }

/// What a block of cells knows of its sides. Local cells are x fastest.
struct BlockSides {
  std::uint32_t cells[kBlockVolume];  // pack_cell
  unsigned char rows[2][kBlockFace];  // by z * 8 + y: a bit for each cell of a row with sides, upwards and downwards
  std::uint32_t first_side;           // of the block, in block order
};

/// One block and octant. Inflow and outflow share memory: a row of 8 x lanes floats (Rows of
/// sweep_kernel_body_internal.h) for each of 8 rows of a face. The step kernel carries the power of the last cell, the
/// characteristic one the power through the face. (i,j,k) are cells along the flow.
struct Block {
  float* x;  // row k, cell j
  float* y;  // row k, cell i
  float* z;  // row j, cell i
  int extent[3];
  int octant;               // bit a: the flow goes up axis a
  const BlockSides* sides;  // null where no cell has one
  const float* sent;        // of the block's sides: r, g, b [W] and the share that passes, 1 - tau
  float* arrived;           // 4 quads a side, one for each octant that can reach it: what the open face would pass [W]
  float* radiance[4];       // 3 floats a cell, OpenVDB's order (z fastest), added to; only for the radiance kernels
};

using Kernel = void (*)(const Constants&, const Block&);

/// The kernels for one instruction set.
struct Kernels {
  const char* name;
  /// @param octets  1, 2, 3, 4 or 6; null for others.
  Kernel (*kernel)(bool characteristic, int octets, bool radiance);
  /// The same lanes for all 64 places of a block's face.
  void (*fill_face)(int octets, const float* lanes, float* face);
  /// A part of a block's face becomes a face of a block whose cells are 1/ratio as long: what goes through each place
  /// is shared out evenly. @param part  which of the ratio x ratio parts, along cells of a row and rows, by flow.
  void (*refine_face)(int octets, int ratio, const int (&part)[2], const float* coarse, float* fine);
  /// And back: what goes through is added up. @param weights  of the fine face's places, cells of a row fastest; null:
  /// all are 1. @param coarse  added to.
  void (*coarsen_face)(int octets, int ratio, const int (&part)[2], const float* fine, const float* weights,
                       float* coarse);
};

Kernels baseline();
Kernels avx2();
Kernels avx512();

/// Those that this machine can run, fastest first. Results differ by rounding only (fused multiply and add).
struct Available {
  Kernels kernels[3];
  int count = 0;
};
Available available();

}  // namespace volgi::sweep
