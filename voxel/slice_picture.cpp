#include "voxel/slice_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <string>

#include "core/error.h"
#include "shaders/shared/color_maps.shared.h"
#include "voxel/picture_text_internal.h"

namespace volgi {
namespace {

constexpr int kSinglePixels = 512, kPanelPixels = 384;  // longest edge of a slice alone, and of one of several
constexpr int kMaxPixels = 16384;
constexpr int kMargin = 12;
constexpr int kBarHeight = 14;
constexpr glm::vec3 kBackground(0.1f), kNoValue(0.27f), kNotFinite(1.0f, 0.0f, 1.0f);
constexpr std::array kAxisNames{'x', 'y', 'z'};

struct Cell {
  bool active = false;
  glm::dvec3 value{0.0};  // scalars in all three
};

template <typename Value>
glm::dvec3 as_vector(const Value& value) {
  constexpr int last = channel_count<Value>() - 1;
  return {channel(value, 0), channel(value, std::min(1, last)), channel(value, last)};
}

bool is_finite(glm::dvec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

double luminance(glm::dvec3 v) { return kLuminance[0] * v.x + kLuminance[1] * v.y + kLuminance[2] * v.z; }

/// Axes of a slice's picture: to the right and vertical, and whether the vertical one points up.
struct Orientation {
  int right, vertical;
  bool up;
};
constexpr std::array<Orientation, 3> kOrientations{{{2, 1, true}, {0, 2, false}, {0, 1, true}}};

struct Slice {
  int width = 0, height = 0;
  std::vector<Cell> cells;  // as seen, row 0 at the top
};

int box_edge(const openvdb::CoordBBox& box, int axis) {
  const std::int64_t edge = std::int64_t(box.max()[axis]) - box.min()[axis] + 1;
  if (edge > kMaxPixels)
    throw Error(ExitCode::over_limit, fmt::format("the grid's box has {} cells along {}: pictures go up to {}", edge,
                                                  kAxisNames[size_t(axis)], kMaxPixels));
  return int(edge);
}

Slice read_slice(const openvdb::GridBase& grid, const openvdb::CoordBBox& box, SlicePlane plane) {
  const Orientation o = kOrientations[size_t(plane.axis)];
  Slice slice{box_edge(box, o.right), box_edge(box, o.vertical), {}};
  slice.cells.reserve(size_t(slice.width) * size_t(slice.height));
  grid.apply<NumberGrids>([&](const auto& typed) {
    const auto values = typed.getConstAccessor();
    openvdb::Coord at;
    at[plane.axis] = plane.index;
    for (int y = 0; y < slice.height; ++y) {
      at[o.vertical] = o.up ? box.max()[o.vertical] - y : box.min()[o.vertical] + y;
      for (int x = 0; x < slice.width; ++x) {
        at[o.right] = box.min()[o.right] + x;
        slice.cells.push_back({values.isValueOn(at), as_vector(values.getValue(at))});
      }
    }
  });
  return slice;
}

/// How values become colours, and what the legend says about it.
class ColorScale {
 public:
  ColorScale(const openvdb::GridBase& grid, const GridSummary& s) {
    double smallest = 0.0;
    for (const ChannelRange& range : s.channels) {
      smallest = std::min(smallest, range.minimum);
      largest_ = std::max({largest_, range.maximum, -range.minimum});
    }
    const bool vector = s.channels.size() == 3;
    if (vector && grid.getVectorType() == openvdb::VEC_COVARIANT_NORMALIZE)
      kind_ = Kind::normal;
    else if (smallest < 0.0)
      kind_ = vector ? Kind::signed_luminance : Kind::signed_number;
    else
      kind_ = vector ? Kind::color : Kind::number;
    const bool share = s.unit == "1" && smallest >= 0.0 && largest_ <= 1.0;
    end_ = share || largest_ == 0.0 ? 1.0 : largest_;
    // As a light meter has it: the mean becomes middle grey, 0.18, and 1 is white, where the bar ends. Near a lamp
    // values are a thousand times those of the room.
    exposed_ = vector && !share && kind_ != Kind::normal && s.lit_luminance > 0.0;
    if (exposed_) end_ = s.lit_luminance / 0.18;
  }

  glm::vec3 operator()(glm::dvec3 v) const {
    if (!is_finite(v)) return kNotFinite;
    switch (kind_) {
      case Kind::number:
        return viridis(float(v.x / end_));
      case Kind::signed_number:
        return diverging(float(v.x / end_));
      case Kind::signed_luminance:
        return diverging(float(luminance(v) / end_));
      case Kind::normal:
        return glm::vec3(0.5 + 0.5 * v);
      case Kind::color:
        break;
    }
    const glm::vec3 scaled(glm::max(v, 0.0) / end_);
    const glm::vec3 display = exposed_ ? tone_map(scaled) : scaled;
    return {srgb_encode(display.x), srgb_encode(display.y), srgb_encode(display.z)};
  }

  bool has_bar() const { return kind_ != Kind::normal; }
  bool is_signed() const { return kind_ == Kind::signed_number || kind_ == Kind::signed_luminance; }
  double first() const { return is_signed() ? -end_ : 0.0; }
  double end() const { return end_; }
  std::string note() const {
    if (kind_ == Kind::normal) return "colour = 0.5 + 0.5 n";
    if (!exposed_) return {};
    return fmt::format("{}, largest {:.4g}", kind_ == Kind::color ? "tone mapped" : "luminance", largest_);
  }

 private:
  enum class Kind { number, signed_number, signed_luminance, color, normal };

  Kind kind_ = Kind::number;
  bool exposed_ = false;
  double largest_ = 0.0, end_ = 1.0;
};

/// "z = 12: 0.406 m", without the place where the slice is not level in the world.
std::string place_text(const openvdb::GridBase& grid, const openvdb::CoordBBox& box, SlicePlane plane) {
  openvdb::Vec3d low = box.min().asVec3d(), high = box.max().asVec3d();
  low[plane.axis] = high[plane.axis] = plane.index;
  const double from = grid.indexToWorld(low)[plane.axis], to = grid.indexToWorld(high)[plane.axis];
  std::string text = fmt::format("{} = {}", kAxisNames[size_t(plane.axis)], plane.index);
  const double cell = grid.voxelSize()[plane.axis];
  if (std::abs(to - from) < 1e-6 * cell) text += fmt::format(": {:.4g} m", std::abs(from) < 1e-6 * cell ? 0.0 : from);
  return text;
}

std::string orientation_text(int axis) {
  const Orientation o = kOrientations[size_t(axis)];
  return fmt::format("right +{}, {} +{}", kAxisNames[size_t(o.right)], o.up ? "up" : "down",
                     kAxisNames[size_t(o.vertical)]);
}

struct Panel {
  Slice slice;
  std::string place, orientation;
  int column_width(int scale) const {
    return std::max({slice.width * scale, text_width(place), text_width(orientation)});
  }
};

void draw_panel(Image& image, const Panel& panel, int left, int top, int scale, const ColorScale& colors) {
  const Slice& s = panel.slice;
  for (int y = 0; y < s.height; ++y)
    for (int x = 0; x < s.width; ++x) {
      const Cell& cell = s.cells[size_t(y) * size_t(s.width) + size_t(x)];
      fill(image, left + x * scale, top + y * scale, scale, scale, cell.active ? colors(cell.value) : kNoValue);
    }
}

void draw_bar(Image& image, int left, int right, int top, const ColorScale& colors) {
  for (int x = left; x < right; ++x) {
    const double at = (double(x - left) + 0.5) / double(right - left);
    fill(image, x, top, 1, kBarHeight, colors(glm::dvec3(colors.first() + at * (colors.end() - colors.first()))));
  }
  const std::string end = fmt::format("{:.4g}", colors.end());
  draw_text(image, left, top + kBarHeight + 4, fmt::format("{:.4g}", colors.first()));
  if (colors.is_signed()) draw_text(image, (left + right - text_width("0")) / 2, top + kBarHeight + 4, "0");
  draw_text(image, right - text_width(end), top + kBarHeight + 4, end);
}

}  // namespace

glm::vec3 viridis(float t) { return shared::viridis(t); }

glm::vec3 diverging(float s) {
  // ColorBrewer's RdBu of 11 classes (C. Brewer, colorbrewer2.org, Apache 2.0), from negative blue to positive red.
  constexpr std::array<glm::vec3, 11> c{{{5, 48, 97},
                                         {33, 102, 172},
                                         {67, 147, 195},
                                         {146, 197, 222},
                                         {209, 229, 240},
                                         {247, 247, 247},
                                         {253, 219, 199},
                                         {244, 165, 130},
                                         {214, 96, 77},
                                         {178, 24, 43},
                                         {103, 0, 31}}};
  const float x = (std::clamp(s, -1.0f, 1.0f) + 1.0f) * 0.5f * float(c.size() - 1);
  const size_t i = std::min(size_t(x), c.size() - 2);
  return glm::mix(c[i], c[i + 1], x - float(i)) / 255.0f;
}

Image slice_picture(const openvdb::GridBase& grid, const GridSummary& summary, const std::vector<SlicePlane>& planes) {
  assert(!planes.empty() && !summary.channels.empty());
  const openvdb::CoordBBox& box = summary.index_box;
  std::vector<Panel> panels;
  int longest = 1, tallest = 1;
  for (const SlicePlane plane : planes) {
    panels.push_back({read_slice(grid, box, plane), place_text(grid, box, plane), orientation_text(plane.axis)});
    longest = std::max({longest, panels.back().slice.width, panels.back().slice.height});
    tallest = std::max(tallest, panels.back().slice.height);
  }
  const int scale = std::max((planes.size() == 1 ? kSinglePixels : kPanelPixels) / longest, 1);

  const ColorScale colors(grid, summary);
  const std::string title = summary.name + (summary.unit.empty() ? "" : " [" + summary.unit + "]");
  const std::string note = colors.note() + (colors.note().empty() ? "" : "; ") + "grey: no value";
  int width = kMargin;
  for (const Panel& panel : panels) width += panel.column_width(scale) + kMargin;
  width = std::max({width, text_width(title) + 2 * kMargin, text_width(note) + 2 * kMargin});
  const int caption = kMargin + tallest * scale + 6;
  const int legend = caption + 2 * kLineHeight + 6;
  const int bar = legend + 2 * kLineHeight;
  Image image(width, bar + (colors.has_bar() ? kBarHeight + 4 + kLineHeight : 0) + kMargin, kBackground);

  int left = kMargin;
  for (const Panel& panel : panels) {
    draw_panel(image, panel, left, kMargin + (tallest - panel.slice.height) * scale, scale, colors);
    draw_text(image, left, caption, panel.place);
    draw_text(image, left, caption + kLineHeight, panel.orientation);
    left += panel.column_width(scale) + kMargin;
  }
  draw_text(image, kMargin, legend, title);
  draw_text(image, kMargin, legend + kLineHeight, note);
  if (colors.has_bar()) draw_bar(image, kMargin, width - kMargin, bar, colors);
  return image;
}

}  // namespace volgi
