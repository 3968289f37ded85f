#pragma once
// The eight columns around a cell's own in a side search, all at once. Plain types: the kernels' files are compiled for
// instruction sets that other files must not use.

namespace volgi {

/// Of one axis of a search. Columns are numbered row by row, without the own one.
struct AroundQuery {
  float point, point_b, point_c;      // on the axis and on the next two, cell units
  float low, low_b, low_c;            // of the cell that the point is in
  float slope_b, slope_c;             // of the plane
  float farthest;                     // columns whose depth is farther from the cell are left out
  int to_face;                        // steps_to_face()
  int stride_b, stride_c;             // bytes between columns
  const unsigned char* own_bytes[2];  // by way: bits of the own column (SideColumns)
  int below[2];                       // cells between the plane's face and the first of the three
};

/// Answers, by column; only those whose bit is set in the result are meaningful.
struct AroundColumns {
  float depth[8];
  int face[8];           // that the plane blocks
  unsigned three[2][8];  // by way: which of three cells from `below` on have a side
};

/// @return bits 0-7: columns with sides along the normal, 8-15: against it. Same bits from every kernel.
using ColumnsAround = unsigned (*)(const AroundQuery& query, AroundColumns& columns);
unsigned columns_around_baseline(const AroundQuery& query, AroundColumns& columns);
unsigned columns_around_avx2(const AroundQuery& query, AroundColumns& columns);  // x86-64 with AVX2 only

/// The fastest that this machine runs.
ColumnsAround columns_around();

}  // namespace volgi
