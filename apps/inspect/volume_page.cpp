#include "apps/inspect/volume_page.h"

#include <fmt/format.h>
#include <openvdb/math/Half.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "voxel/vdb_summary.h"

namespace volgi::app {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint64_t MOST_BYTES = std::uint64_t(96) << 20;
constexpr std::uint16_t NO_VALUE = 0xfe00;  // a NaN with a sign; cells whose value is none have 0x7e00

std::string base64(const unsigned char* bytes, size_t size) {
  constexpr const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((size + 2) / 3 * 4);
  for (size_t i = 0; i < size; i += 3) {
    const auto byte = [&](size_t k) { return i + k < size ? std::uint32_t(bytes[i + k]) : 0u; };
    const std::uint32_t three = byte(0) << 16 | byte(1) << 8 | byte(2);
    for (size_t k = 0; k < 4; ++k) out += i + k <= size ? digits[three >> (18 - 6 * k) & 63] : '=';
  }
  return out;
}

std::uint16_t half_of(double value) {
  if (std::isnan(value)) return 0x7e00;
  if (std::isinf(value)) return value > 0 ? 0x7c00 : 0xfc00;
  return openvdb::math::half(float(value)).bits();
}

/// Largest size of any channel, as a power of two that halves hold with room to spare.
int exponent_of(const GridSummary& s) {
  double largest = 0.0;
  for (const ChannelRange& c : s.channels) largest = std::max({largest, std::abs(c.minimum), std::abs(c.maximum)});
  return largest > 0.0 ? 14 - std::ilogb(largest) : 0;
}

std::uint64_t bytes_of(const GridSummary& s) {
  const openvdb::Coord edge = s.index_box.dim();
  return 2 * s.channels.size() * std::uint64_t(edge.x()) * std::uint64_t(edge.y()) * std::uint64_t(edge.z());
}

/// Of the cells of the active box, x fastest, channels of a cell beside each other.
std::string values_of(const openvdb::GridBase& grid, const GridSummary& s, int exponent) {
  std::vector<std::uint16_t> halves;
  halves.reserve(bytes_of(s) / 2);
  const openvdb::Coord low = s.index_box.min(), high = s.index_box.max();
  const int channels = int(s.channels.size());
  grid.apply<NumberGrids>([&](const auto& typed) {
    const auto values = typed.getConstAccessor();
    openvdb::Coord at;
    for (at[2] = low[2]; at[2] <= high[2]; ++at[2]) {
      for (at[1] = low[1]; at[1] <= high[1]; ++at[1]) {
        for (at[0] = low[0]; at[0] <= high[0]; ++at[0]) {
          const bool active = values.isValueOn(at);
          const auto value = values.getValue(at);
          for (int c = 0; c < channels; ++c)
            halves.push_back(active ? half_of(std::ldexp(channel(value, c), exponent)) : NO_VALUE);
        }
      }
    }
  });
  std::vector<unsigned char> bytes(2 * halves.size());
  for (size_t i = 0; i < halves.size(); ++i) {
    bytes[2 * i] = static_cast<unsigned char>(halves[i] & 0xff);
    bytes[2 * i + 1] = static_cast<unsigned char>(halves[i] >> 8);
  }
  return base64(bytes.data(), bytes.size());
}

/// What the page's colours mean.
const char* kind_of(const openvdb::GridBase& grid, const GridSummary& s) {
  if (s.channels.size() == 1) return "number";
  return grid.getVectorType() == openvdb::VEC_COVARIANT_NORMALIZE ? "normal" : "colour";
}

Json json_of(const openvdb::GridBase& grid, const GridSummary& s) {
  const auto three = [](const auto& v) { return Json{v[0], v[1], v[2]}; };
  const int exponent = exponent_of(s);
  Json ranges = Json::array();
  for (const ChannelRange& c : s.channels) ranges.push_back({c.minimum, c.maximum, c.mean});
  return {{"name", s.name},
          {"unit", s.unit},
          {"description", s.description},
          {"kind", kind_of(grid, s)},
          {"cells", three(s.index_box.dim())},
          {"first", three(s.index_box.min())},
          {"centre", three(grid.indexToWorld(s.index_box.min()))},
          {"cell_m", three(s.cell_size_m)},
          {"active", s.active_cells},
          {"ranges", ranges},
          {"exponent", exponent},
          {"values", values_of(grid, s, exponent)}};
}

void replace(std::string& text, std::string_view place, const std::string& by) {
  const size_t at = text.find(place);
  if (at != std::string::npos) text.replace(at, place.size(), by);
}

/// Between tags of HTML.
std::string escaped_text(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '<')
      out += "&lt;";
    else if (c == '&')
      out += "&amp;";
    else
      out += c;
  }
  return out;
}

/// In a script element, which ends at "</".
std::string in_script(std::string text) {
  for (size_t at = text.find("</"); at != std::string::npos; at = text.find("</", at + 3)) text.insert(at + 1, "\\");
  return text;
}

}  // namespace

std::string volume_page(const std::string& title, const openvdb::GridPtrVec& grids) {
  std::vector<std::pair<openvdb::GridBase::Ptr, GridSummary>> shown;
  std::uint64_t bytes = 0;
  for (const auto& grid : grids) {
    GridSummary s = summarise(*grid);
    if (s.channels.empty()) continue;
    bytes += bytes_of(s);
    shown.emplace_back(grid, std::move(s));
  }
  if (shown.empty()) throw Error(ExitCode::bad_input, title + ": no active cells with numbers to show");
  if (bytes > MOST_BYTES)
    throw Error(ExitCode::over_limit,
                fmt::format("{}: {} MiB of values are more than a page holds, {} MiB; choose one grid with --grid",
                            title, bytes >> 20, MOST_BYTES >> 20));
  Json data{{"title", title}, {"grids", Json::array()}};
  for (const auto& [grid, summary] : shown) data["grids"].push_back(json_of(*grid, summary));
  std::string page(inspect_text("page.html"));
  replace(page, "{{title}}", escaped_text(title));
  replace(page, "{{title}}", escaped_text(title));
  replace(page, "{{style}}", std::string(inspect_text("page.css")));
  replace(page, "{{data}}", in_script(data.dump(-1, ' ', false, Json::error_handler_t::replace)));
  replace(page, "{{script}}", std::string(inspect_text("page.js")));
  return page;
}

}  // namespace volgi::app
