#include "voxel/vdb_summary.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "voxel/vdb_file.h"

namespace volgi {
namespace {

template <typename Value>
bool is_finite(const Value& value) {
  for (int c = 0; c < channel_count<Value>(); ++c) {
    if (!std::isfinite(channel(value, c))) return false;
  }
  return true;
}

/// Another pass, so that large means do not eat small deviations.
template <typename GridType>
void add_deviations(const GridType& grid, double finite_cells, std::vector<ChannelRange>& ranges) {
  std::vector<double> squares(ranges.size(), 0.0);
  for (auto it = grid.cbeginValueOn(); it; ++it) {
    if (!is_finite(*it)) continue;
    for (size_t c = 0; c < ranges.size(); ++c) {
      const double off = channel(*it, int(c)) - ranges[c].mean;
      squares[c] += off * off * double(it.getVoxelCount());
    }
  }
  for (size_t c = 0; c < ranges.size(); ++c) ranges[c].deviation = std::sqrt(squares[c] / finite_cells);
}

template <typename GridType>
void count_values(const GridType& grid, const ChannelRange& range, int of_channel, std::vector<std::uint64_t>& counts) {
  const double width = range.maximum - range.minimum;
  for (auto it = grid.cbeginValueOn(); it; ++it) {
    if (!is_finite(*it)) continue;
    const double share = width > 0.0 ? (channel(*it, of_channel) - range.minimum) / width : 0.0;
    counts[std::min(size_t(share * double(counts.size())), counts.size() - 1)] += it.getVoxelCount();
  }
}

template <typename GridType>
void add_ranges(const GridType& grid, GridSummary& summary) {
  constexpr int count = channel_count<typename GridType::ValueType>();
  constexpr double infinity = std::numeric_limits<double>::infinity();
  std::vector<ChannelRange> ranges(size_t(count), ChannelRange{infinity, -infinity});
  double finite_cells = 0.0, lit_cells = 0.0, lit = 0.0;
  for (auto it = grid.cbeginValueOn(); it; ++it) {
    const auto cells = it.getVoxelCount();
    if (!is_finite(*it)) {
      summary.not_finite += cells;
      for (int c = 0; c < count; ++c) {
        if (!std::isnan(channel(*it, c))) continue;
        summary.not_a_number += cells;
        break;
      }
      continue;
    }
    finite_cells += double(cells);
    double luminance = 0.0;
    for (int c = 0; c < count; ++c) {
      ChannelRange& range = ranges[size_t(c)];
      const double value = channel(*it, c);
      range.minimum = std::min(range.minimum, value);
      range.maximum = std::max(range.maximum, value);
      range.mean += value * double(cells);
      luminance += kLuminance[c] * value;
    }
    if (luminance == 0.0) continue;
    lit_cells += double(cells);
    lit += std::abs(luminance) * double(cells);
  }
  if (finite_cells == 0.0) return;
  for (ChannelRange& range : ranges) range.mean /= finite_cells;
  add_deviations(grid, finite_cells, ranges);
  if (count == 3 && lit_cells > 0.0) summary.lit_luminance = lit / lit_cells;
  summary.channels = std::move(ranges);
}

std::string text_of(const openvdb::MetaMap& metadata, const char* key) {
  const openvdb::Metadata::ConstPtr value = metadata[key];
  return value ? value->str() : std::string();
}

bool is_shown_elsewhere(const std::string& key) {
  using openvdb::GridBase;
  for (const char* known :
       {GridBase::META_GRID_NAME, GridBase::META_GRID_CLASS, GridBase::META_VECTOR_TYPE, kUnitKey, kDescriptionKey})
    if (key == known) return true;
  return key.starts_with("file_");  // OpenVDB's own statistics
}

}  // namespace

GridSummary summarise(const openvdb::GridBase& grid) {
  GridSummary s;
  s.name = grid.getName();
  s.type = grid.valueType();
  s.unit = text_of(grid, kUnitKey);
  s.description = text_of(grid, kDescriptionKey);
  s.grid_class = openvdb::GridBase::gridClassToString(grid.getGridClass());
  if (s.type.starts_with("vec")) s.vector_type = openvdb::GridBase::vecTypeToString(grid.getVectorType());
  s.active_cells = grid.activeVoxelCount();
  s.memory_bytes = grid.memUsage();
  s.cell_size_m = grid.voxelSize();
  s.index_box = grid.evalActiveVoxelBoundingBox();
  if (s.active_cells == 0 || s.index_box.empty()) return s;
  const openvdb::BBoxd cells(s.index_box.min().asVec3d() - 0.5, s.index_box.max().asVec3d() + 0.5);
  s.world_box = grid.transform().indexToWorld(cells);
  const openvdb::Vec3d extent = cells.extents();
  s.active_share = double(s.active_cells) / (extent.x() * extent.y() * extent.z());
  grid.apply<NumberGrids>([&](const auto& typed) { add_ranges(typed, s); });
  return s;
}

std::vector<std::uint64_t> histogram(const openvdb::GridBase& grid, const GridSummary& summary, int channel, int bins) {
  if (summary.channels.empty()) return {};
  std::vector<std::uint64_t> counts(static_cast<size_t>(bins), 0);
  grid.apply<NumberGrids>(
      [&](const auto& typed) { count_values(typed, summary.channels[size_t(channel)], channel, counts); });
  return counts;
}

std::vector<std::pair<std::string, openvdb::Metadata::ConstPtr>> further_metadata(const openvdb::MetaMap& metadata) {
  std::vector<std::pair<std::string, openvdb::Metadata::ConstPtr>> further;
  for (auto it = metadata.beginMeta(); it != metadata.endMeta(); ++it)
    if (it->second && !is_shown_elsewhere(it->first)) further.emplace_back(it->first, it->second);
  return further;
}

}  // namespace volgi
