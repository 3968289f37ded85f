#pragma once
#include <openvdb/openvdb.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace volgi {

/// Grids with numbers in them: those that have ranges and pictures.
using NumberGrids = openvdb::TypeList<openvdb::FloatGrid, openvdb::DoubleGrid, openvdb::Int32Grid, openvdb::Int64Grid,
                                      openvdb::BoolGrid, openvdb::Vec3SGrid, openvdb::Vec3DGrid, openvdb::Vec3IGrid>;

/// Channels of a value of such a grid, 1 or 3, and one of them.
template <typename Value>
constexpr int channel_count() {
  return openvdb::VecTraits<Value>::IsVec ? openvdb::VecTraits<Value>::Size : 1;
}
template <typename Value>
double channel(const Value& value, int c) {
  if constexpr (openvdb::VecTraits<Value>::IsVec)
    return double(value[c]);
  else
    return double(value);
}

/// Range of one channel over the active cells, in the grid's unit. Cells that are not finite are left out.
struct ChannelRange {
  double minimum = 0.0;
  double maximum = 0.0;
  double mean = 0.0;
  double deviation = 0.0;  // standard deviation
};

/// What a grid is and holds, as `volgi inspect` shows it.
struct GridSummary {
  std::string name, type, unit, description, grid_class;
  std::string vector_type;       // empty for scalars
  openvdb::CoordBBox index_box;  // of the active cells, both ends inside; empty when there are none
  openvdb::BBoxd world_box;      // outer faces of those cells [m]
  openvdb::Vec3d cell_size_m{0.0};
  std::uint64_t active_cells = 0;
  double active_share = 0.0;           // of the index box
  std::uint64_t not_finite = 0;        // active cells with a NaN or an infinity
  std::uint64_t not_a_number = 0;      // those with a NaN
  std::vector<ChannelRange> channels;  // 1 or 3; empty for types without numbers and for grids without active cells
  double lit_luminance = 0.0;          // mean size of the luminance (Rec. 709) of colours where it is not 0
  std::uint64_t memory_bytes = 0;
};

inline constexpr double kLuminance[3] = {0.2126, 0.7152, 0.0722};  // Rec. 709

/// @param grid  any type; ranges are for scalars and 3-vectors. Index (i,j,k) is a cell's centre (cell_volumes.h).
/// Cost: one pass over the active values, in the order of the tree, so that means do not depend on threads.
GridSummary summarise(const openvdb::GridBase& grid);

/// Finite active cells by the value of a channel, in `bins` equal steps from the channel's minimum to its maximum; all
/// in the first where these are one. Of types without numbers nothing.
std::vector<std::uint64_t> histogram(const openvdb::GridBase& grid, const GridSummary& summary, int channel, int bins);

/// Metadata in the order of the keys; of a grid, without what summarise() says and OpenVDB's own statistics.
std::vector<std::pair<std::string, openvdb::Metadata::ConstPtr>> further_metadata(const openvdb::MetaMap& metadata);

}  // namespace volgi
