#include "voxel/volume_view.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "voxel/picture_text_internal.h"
#include "voxel/slice_picture.h"

namespace volgi {

namespace {

using Kind = VolumeField::Kind;
using Held = VolumeField::Held;

constexpr glm::vec3 BACKGROUND(0.1f), NO_VALUE(0.27f), NOT_FINITE(1.0f, 0.0f, 1.0f), FRAME(1.0f, 0.75f, 0.3f);
constexpr int MARGIN = 8, BAR_HEIGHT = 12, LEAST_FOR_TEXT = 160;  // [px]

/// Axes of a slice: to the right and vertical, and whether the vertical one points up (as slice_picture.h has it).
struct Orientation {
  int right, vertical;
  bool up;
};
constexpr std::array<Orientation, 3> ORIENTATIONS{{{2, 1, true}, {0, 2, false}, {0, 1, true}}};

struct Rectangle {
  int left = 0, top = 0, width = 0, height = 0;
  bool contains(glm::ivec2 p) const { return p.x >= left && p.y >= top && p.x < left + width && p.y < top + height; }
};

bool has_text(glm::ivec2 size) { return std::min(size.x, size.y) >= LEAST_FOR_TEXT; }

/// Below all parts: the grid's name, and the bar with its ends.
int legend_height(glm::ivec2 size) { return has_text(size) ? 2 * kLineHeight + BAR_HEIGHT + 2 * MARGIN : 0; }

/// Where the k-th part is, without its caption.
Rectangle place_of(const VolumeLook& look, glm::ivec2 size, size_t k) {
  const int across = look.parts.size() > 1 ? 2 : 1, caption = has_text(size) ? kLineHeight : 0;
  const int height = (size.y - legend_height(size)) / across, width = size.x / across;
  const int column = int(k) % across, row = int(k) / across, gap = has_text(size) ? MARGIN : 1;
  return {column * width + gap, row * height + gap, std::max(width - 2 * gap, 1),
          std::max(height - caption - 2 * gap, 1)};
}

// --- colours --------------------------------------------------------------------------------------------------------

/// Display colours of cells.
class Painter {
 public:
  Painter(const VolumeField& field, const VolumeScalars& scalars, const VolumeLook& look)
      : field_(field),
        scalars_(scalars),
        map_(look.map),
        logarithmic_(look.logarithmic),
        low_(look.low),
        high_(look.high) {
    if (map_ != VolumeMap::diverging) return;
    high_ = std::max(std::abs(low_), std::abs(high_));
    low_ = -high_;
  }

  glm::vec3 operator()(size_t i) const {
    if (field_.held[i] == Held::none) return NO_VALUE;
    if (field_.held[i] == Held::no_number) return NOT_FINITE;
    if (map_ != VolumeMap::colour) return of(double(scalars_.values[i]));
    if (field_.kind == Kind::normal) return glm::clamp(0.5f + 0.5f * field_.values[i], 0.0f, 1.0f);
    glm::vec3 display;
    for (int c = 0; c < 3; ++c) display[c] = srgb_encode(share(double(field_.values[i][c])));
    return display;
  }
  glm::vec3 of(double value) const {
    const float t = share(value);
    switch (map_) {
      case VolumeMap::viridis:
        return viridis(t);
      case VolumeMap::grey:
        return glm::vec3(t);
      case VolumeMap::diverging:
        return diverging(2.0f * t - 1.0f);
      case VolumeMap::colour:
        break;
    }
    return glm::vec3(srgb_encode(t));
  }
  double low() const { return low_; }
  double high() const { return high_; }

 private:
  /// Of the range, 0 to 1.
  float share(double value) const {
    constexpr double DECADES = 1e-4;
    const double least = std::max(low_, high_ * DECADES);
    if (logarithmic_ && map_ != VolumeMap::diverging)
      return high_ > least
                 ? float(std::clamp(std::log(std::max(value, least) / least) / std::log(high_ / least), 0.0, 1.0))
                 : 0.0f;
    return high_ > low_ ? float(std::clamp((value - low_) / (high_ - low_), 0.0, 1.0)) : 0.0f;
  }

  const VolumeField& field_;
  const VolumeScalars& scalars_;
  VolumeMap map_;
  bool logarithmic_;
  double low_, high_;
};

// --- slices ---------------------------------------------------------------------------------------------------------

/// Where a slice's cells are in its part: as large as they fit, whole pixels where they have more than one.
struct SliceFrame {
  Orientation axes{};
  int across = 0, down = 0;  // cells
  double pixels = 1.0;       // an edge of a cell
  double left = 0.0, top = 0.0;

  std::optional<glm::ivec2> cell(glm::ivec2 pixel) const {  // column, row as shown
    const glm::ivec2 at(int(std::floor((pixel.x + 0.5 - left) / pixels)),
                        int(std::floor((pixel.y + 0.5 - top) / pixels)));
    if (at.x < 0 || at.y < 0 || at.x >= across || at.y >= down) return std::nullopt;
    return at;
  }
};

SliceFrame slice_frame(const VolumeField& field, int axis, const Rectangle& place) {
  SliceFrame frame{ORIENTATIONS[size_t(axis)]};
  frame.across = field.cells[frame.axes.right];
  frame.down = field.cells[frame.axes.vertical];
  frame.pixels = std::min(double(place.width) / frame.across, double(place.height) / frame.down);
  if (frame.pixels > 1.0) frame.pixels = std::floor(frame.pixels);
  frame.left = std::floor(place.left + 0.5 * (place.width - frame.pixels * frame.across));
  frame.top = std::floor(place.top + 0.5 * (place.height - frame.pixels * frame.down));
  return frame;
}

glm::ivec3 cell_of(const SliceFrame& frame, glm::ivec2 shown, glm::ivec3 through) {
  through[frame.axes.right] = shown.x;
  through[frame.axes.vertical] = frame.axes.up ? frame.down - 1 - shown.y : shown.y;
  return through;
}

void frame_cell(Image& image, const SliceFrame& frame, glm::ivec3 cell) {
  const int row = frame.axes.up ? frame.down - 1 - cell[frame.axes.vertical] : cell[frame.axes.vertical];
  const int edge = std::max(int(frame.pixels), 1);
  const int x = int(frame.left + frame.pixels * cell[frame.axes.right]), y = int(frame.top + frame.pixels * row);
  fill(image, x - 1, y - 1, edge + 2, 1, FRAME);
  fill(image, x - 1, y + edge, edge + 2, 1, FRAME);
  fill(image, x - 1, y - 1, 1, edge + 2, FRAME);
  fill(image, x + edge, y - 1, 1, edge + 2, FRAME);
}

void draw_slice(Image& image, const VolumeField& field, const VolumeLook& look, int axis, const Rectangle& place,
                const Painter& colour) {
  const SliceFrame frame = slice_frame(field, axis, place);
  tbb::parallel_for(place.top, place.top + place.height, [&](int y) {
    for (int x = place.left; x < place.left + place.width; ++x) {
      if (const auto shown = frame.cell({x, y}))
        image.at(x, y) = colour(field.index(cell_of(frame, *shown, look.cell)));
    }
  });
  frame_cell(image, frame, look.cell);
}

std::string number(double v) { return fmt::format("{:.4g}", v == 0.0 ? 0.0 : v); }

/// Where a slice is and how it stands, in two parts.
std::array<std::string, 2> slice_text(const VolumeField& field, const VolumeLook& look, int axis) {
  constexpr std::string_view NAMES = "xyz";
  const Orientation o = ORIENTATIONS[size_t(axis)];
  return {fmt::format("{} = {}: {} m", NAMES[size_t(axis)], field.first[axis] + field.step * look.cell[axis],
                      number(field.centre(look.cell)[axis])),
          fmt::format("; right +{}, {} +{}", NAMES[size_t(o.right)], o.up ? "up" : "down", NAMES[size_t(o.vertical)])};
}

/// As much of it as there is room for.
void draw_caption(Image& image, const Rectangle& place, const std::array<std::string, 2>& text) {
  const std::string whole = text[0] + text[1];
  const std::string& fits = text_width(whole) <= place.width ? whole : text[0];
  if (text_width(fits) <= place.width) draw_text(image, place.left, place.top + place.height + 2, fits);
}

// --- in space -------------------------------------------------------------------------------------------------------

struct Hit {
  glm::ivec3 cell;
  int axis;  // of the face that is seen
};

/// Parallel rays into the field, in units of cells.
class OrbitView {
 public:
  OrbitView(const VolumeField& field, const VolumeScalars& scalars, const VolumeLook& look, const Rectangle& place)
      : field_(field), scalars_(scalars), low_(look.low), cut_(look.cut), middle_(look.cell), place_(place) {
    constexpr double SHARE_OF_PLACE = 0.95;
    const double yaw = glm::radians(look.yaw_deg), pitch = glm::radians(look.pitch_deg);
    const double cy = std::cos(yaw), sy = std::sin(yaw), cp = std::cos(pitch), sp = std::sin(pitch);
    right_ = {cy, 0.0, -sy};
    up_ = {-sp * sy, cp, -sp * cy};
    back_ = {cp * sy, sp, cp * cy};
    pixels_ = look.zoom * SHARE_OF_PLACE * std::min(place.width, place.height) / glm::length(glm::dvec3(field.cells));
  }

  glm::dvec3 back() const { return back_; }

  std::optional<Hit> hit(glm::ivec2 pixel) const {
    const double x = (pixel.x + 0.5 - place_.left - 0.5 * place_.width) / pixels_;
    const double y = (pixel.y + 0.5 - place_.top - 0.5 * place_.height) / pixels_;
    const glm::dvec3 n(field_.cells);
    const glm::dvec3 origin = 0.5 * n + x * right_ - y * up_ + glm::length(n) * back_;
    return walk(origin, -back_);
  }

 private:
  bool seen(glm::ivec3 cell) const {
    const size_t i = field_.index(cell);
    return field_.held[i] == Held::number && double(scalars_.values[i]) > low_ && !(cut_ && is_cut(cell));
  }

  bool is_cut(glm::ivec3 cell) const {
    for (int a = 0; a < 3; ++a) {
      const int beyond = back_[a] > 0.0 ? cell[a] - middle_[a] : middle_[a] - cell[a];
      if (beyond <= 0) return false;
    }
    return true;
  }

  /// Amanatides and Woo: A fast voxel traversal algorithm for ray tracing, Eurographics 1987.
  std::optional<Hit> walk(glm::dvec3 origin, glm::dvec3 d) const {
    double enter = 0.0, leave = std::numeric_limits<double>::infinity();
    int axis = 2;
    for (int a = 0; a < 3; ++a) {
      if (std::abs(d[a]) < 1e-12) {
        if (origin[a] < 0.0 || origin[a] >= field_.cells[a]) return std::nullopt;
        continue;
      }
      const double t0 = (d[a] > 0.0 ? -origin[a] : field_.cells[a] - origin[a]) / d[a];
      const double t1 = (d[a] > 0.0 ? field_.cells[a] - origin[a] : -origin[a]) / d[a];
      if (t0 > enter) enter = t0, axis = a;
      leave = std::min(leave, t1);
    }
    if (enter >= leave) return std::nullopt;
    glm::ivec3 cell, step;
    glm::dvec3 next(std::numeric_limits<double>::infinity()), each(0.0);
    for (int a = 0; a < 3; ++a) {
      cell[a] = std::clamp(int(std::floor(origin[a] + enter * d[a])), 0, field_.cells[a] - 1);
      step[a] = d[a] > 0.0 ? 1 : -1;
      if (std::abs(d[a]) < 1e-12) continue;
      next[a] = (cell[a] + (step[a] > 0 ? 1 : 0) - origin[a]) / d[a];
      each[a] = 1.0 / std::abs(d[a]);
    }
    while (!seen(cell)) {
      axis = next.x < next.y ? (next.x < next.z ? 0 : 2) : (next.y < next.z ? 1 : 2);
      cell[axis] += step[axis];
      next[axis] += each[axis];
      if (cell[axis] < 0 || cell[axis] >= field_.cells[axis]) return std::nullopt;
    }
    return Hit{cell, axis};
  }

  const VolumeField& field_;
  const VolumeScalars& scalars_;
  double low_;
  bool cut_;
  glm::ivec3 middle_;
  Rectangle place_;
  double pixels_ = 1.0;
  glm::dvec3 right_, up_, back_;
};

void draw_orbit(Image& image, const VolumeField& field, const VolumeScalars& scalars, const VolumeLook& look,
                const Rectangle& place, const Painter& colour) {
  const OrbitView view(field, scalars, look, place);
  tbb::parallel_for(place.top, place.top + place.height, [&](int y) {
    for (int x = place.left; x < place.left + place.width; ++x) {
      const std::optional<Hit> hit = view.hit({x, y});
      if (!hit) continue;
      constexpr float EDGE_ON = 0.55f;  // brightness of a face that is seen from its side
      const float facing = float(std::abs(view.back()[hit->axis]));
      const bool chosen = hit->cell == look.cell;
      image.at(x, y) = (chosen ? FRAME : colour(field.index(hit->cell))) * (EDGE_ON + (1.0f - EDGE_ON) * facing);
    }
  });
}

// --- together -------------------------------------------------------------------------------------------------------

void draw_legend(Image& image, const VolumeField& field, const VolumeLook& look, const Painter& colour) {
  const int top = image.height - legend_height({image.width, image.height}), right = image.width - MARGIN;
  std::string title = field.name + (field.unit.empty() ? "" : " [" + field.unit + "]");
  if (field.kind != Kind::number) title += ", " + look.channel;
  if (field.step > 1) title += fmt::format(", means of {0} x {0} x {0} cells", field.step);
  draw_text(image, MARGIN, top, title);
  if (field.kind == Kind::normal && look.map == VolumeMap::colour) {
    draw_text(image, MARGIN, top + kLineHeight, "colour = 0.5 + 0.5 n");
    return;
  }
  for (int x = MARGIN; x < right; ++x) {
    double at = (x - MARGIN + 0.5) / (right - MARGIN);
    if (look.logarithmic && look.map != VolumeMap::diverging) {
      const double least = std::max(colour.low(), colour.high() * 1e-4);
      at = colour.high() > least ? least * std::pow(colour.high() / least, at) : 0.0;
    } else {
      at = colour.low() + at * (colour.high() - colour.low());
    }
    fill(image, x, top + kLineHeight, 1, BAR_HEIGHT, colour.of(at));
  }
  draw_text(image, MARGIN, top + kLineHeight + BAR_HEIGHT + 4, number(colour.low()));
  const std::string end = number(colour.high()) + (look.logarithmic ? ", logarithmic" : "");
  draw_text(image, right - text_width(end), top + kLineHeight + BAR_HEIGHT + 4, end);
}

}  // namespace

void suit_range(const VolumeField& field, const VolumeScalars& scalars, VolumeLook& look) {
  constexpr double OUTLIERS = 4.0;
  look.map = look.channel == "all" ? VolumeMap::colour : scalars.low < 0.0 ? VolumeMap::diverging : VolumeMap::viridis;
  const bool spread = scalars.high > OUTLIERS * scalars.most && scalars.most > 0.0;
  look.low = std::min(scalars.low, 0.0);
  look.high = spread ? scalars.most : scalars.high;
  // Normals are seen in space whatever way they point.
  if (field.kind == Kind::normal && look.channel == "all") look.low = -1.0 - 1e-3, look.high = 1.0;
  if (!(look.high > look.low)) look.high = look.low + 1.0;
}

void suit_look(const VolumeField& field, VolumeLook& look) {
  look.channel = channels_of(field.kind).front();
  look.cell = field.cells / 2;
  suit_range(field, scalars_of(field, look.channel), look);
}

Image volume_picture(const VolumeField& field, const VolumeScalars& scalars, const VolumeLook& look, glm::ivec2 size) {
  assert(scalars.values.size() == field.values.size() && field.contains(look.cell));
  Image image(size.x, size.y, BACKGROUND);
  const Painter colour(field, scalars, look);
  for (size_t k = 0; k < look.parts.size(); ++k) {
    const Rectangle place = place_of(look, size, k);
    if (place.left + place.width > size.x || place.top + place.height > size.y) continue;  // no room for it
    const int axis = int(look.parts[k]);
    if (look.parts[k] == VolumePart::orbit)
      draw_orbit(image, field, scalars, look, place, colour);
    else
      draw_slice(image, field, look, axis, place, colour);
    if (!has_text(size)) continue;
    if (look.parts[k] == VolumePart::orbit)
      draw_caption(image, place,
                   {fmt::format("above {}", number(look.low)),
                    fmt::format(", from {:.0f}, {:.0f} degrees", look.yaw_deg, look.pitch_deg)});
    else
      draw_caption(image, place, slice_text(field, look, axis));
  }
  if (has_text(size)) draw_legend(image, field, look, colour);
  return image;
}

std::optional<VolumePart> part_at(const VolumeLook& look, glm::ivec2 size, glm::ivec2 pixel) {
  for (size_t k = 0; k < look.parts.size(); ++k) {
    if (place_of(look, size, k).contains(pixel)) return look.parts[k];
  }
  return std::nullopt;
}

std::optional<glm::ivec3> cell_at(const VolumeField& field, const VolumeScalars& scalars, const VolumeLook& look,
                                  glm::ivec2 size, glm::ivec2 pixel) {
  for (size_t k = 0; k < look.parts.size(); ++k) {
    const Rectangle place = place_of(look, size, k);
    if (!place.contains(pixel)) continue;
    if (look.parts[k] == VolumePart::orbit) {
      const std::optional<Hit> hit = OrbitView(field, scalars, look, place).hit(pixel);
      return hit ? std::optional(hit->cell) : std::nullopt;
    }
    const SliceFrame frame = slice_frame(field, int(look.parts[k]), place);
    const auto shown = frame.cell(pixel);
    return shown ? std::optional(cell_of(frame, *shown, look.cell)) : std::nullopt;
  }
  return std::nullopt;
}

std::string cell_text(const VolumeField& field, glm::ivec3 cell) {
  const glm::dvec3 at = field.centre(cell);
  const size_t i = field.index(cell);
  const glm::vec3 v = field.values[i];
  std::string value = "no value";
  if (field.held[i] == Held::no_number) value = "no number";
  if (field.held[i] == Held::number)
    value = field.kind == Kind::number ? fmt::format("{:.5g} {}", v.x, field.unit)
                                       : fmt::format("{:.5g} {:.5g} {:.5g} {}", v.x, v.y, v.z, field.unit);
  return fmt::format("cell {}, {}, {} at {}, {}, {} m: {}", field.first.x() + field.step * cell.x,
                     field.first.y() + field.step * cell.y, field.first.z() + field.step * cell.z, number(at.x),
                     number(at.y), number(at.z), value);
}

}  // namespace volgi
