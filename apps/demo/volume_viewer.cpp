#include "apps/demo/volume_viewer.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>

#include "core/error.h"

namespace volgi::demo {

namespace {

constexpr const char* RADIANCE = "radiance";

/// Azimuth from −Z towards +X, height above the horizon.
glm::vec3 direction_of(glm::vec2 deg) {
  const glm::vec2 a = glm::radians(deg);
  return {std::cos(a.y) * std::sin(a.x), std::sin(a.y), -std::cos(a.y) * std::cos(a.x)};
}

std::vector<VolumePart> parts_of(const std::string& view) {
  if (view == "sheet") return VolumeLook().parts;
  if (view == "x") return {VolumePart::x};
  if (view == "y") return {VolumePart::y};
  if (view == "z") return {VolumePart::z};
  if (view == "orbit") return {VolumePart::orbit};
  throw Error(ExitCode::usage, "view " + view + ": sheet, x, y, z or orbit");
}

}  // namespace

bool is_volume_file(const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  for (char& c : ending) c = char(std::tolower(static_cast<unsigned char>(c)));
  return ending == ".vdb";
}

VolumeViewer::VolumeViewer(std::filesystem::path file) : file_(std::move(file)) {
  const VdbFile vdb = read_vdb(file_);
  for (const openvdb::GridBase::Ptr& grid : vdb.grids) {
    GridSummary summary = summarise(*grid);
    if (summary.channels.empty()) continue;
    names_.push_back(summary.name);
    file_grids_.push_back({grid, std::move(summary)});
  }
  if (file_grids_.empty())
    throw Error(ExitCode::bad_input, file_.string() + ": no grid has active cells with numbers to show");
  find_bands();
  const auto fluence = std::find(names_.begin(), names_.end(), "fluence");
  take_grid(fluence == names_.end() ? 0 : size_t(fluence - names_.begin()));
}

void VolumeViewer::find_bands() {
  for (const char* name : kBandNames) {
    const auto at = std::find(names_.begin(), names_.end(), name);
    if (at == names_.end()) break;
    const size_t number = size_t(at - names_.begin());
    const GridSummary& s = file_grids_[number].summary;
    if (s.channels.size() != 3) break;
    if (!bands_.empty() && s.index_box != file_grids_[bands_[0]].summary.index_box) break;
    bands_.push_back(number);
  }
  bands_.resize(bands_.size() >= 9 ? 9 : bands_.size() >= 4 ? 4 : 0);
  if (!bands_.empty()) names_.emplace_back(RADIANCE);
}

void VolumeViewer::take_radiance() {
  if (band_fields_.empty()) {
    for (const size_t band : bands_)
      band_fields_.push_back(volume_field(*file_grids_[band].grid, file_grids_[band].summary));
  }
  field_ = radiance_field(band_fields_, direction_of(direction_deg_));
}

void VolumeViewer::take_grid(size_t number) {
  const VolumeField::Kind kind_before = field_.kind;
  const glm::ivec3 cells_before = field_.cells, cell_before = look_.cell;
  grid_ = number;
  if (shows_radiance())
    take_radiance();
  else
    field_ = volume_field(*file_grids_[number].grid, file_grids_[number].summary);
  if (kind_before != field_.kind || look_.channel == "value") look_.channel = channels_of(field_.kind).front();
  look_.cell = cells_before == field_.cells ? cell_before : field_.cells / 2;
  take_scalars();
  suit_range();
}

void VolumeViewer::take_scalars() {
  scalars_ = scalars_of(field_, look_.channel);
  ++changes_;
}

std::string VolumeViewer::view() const {
  if (look_.parts.size() > 1) return "sheet";
  return look_.parts[0] == VolumePart::orbit ? "orbit" : std::string(1, "xyz"[int(look_.parts[0])]);
}

std::vector<float> VolumeViewer::histogram(int bins) const {
  std::vector<float> counts(size_t(bins), 0.0f);
  const double spread = scalars_.high - scalars_.low;
  for (size_t i = 0; i < scalars_.values.size(); ++i) {
    if (field_.held[i] != VolumeField::Held::number) continue;
    const double share = spread > 0.0 ? (double(scalars_.values[i]) - scalars_.low) / spread : 0.0;
    ++counts[size_t(std::clamp(int(share * bins), 0, bins - 1))];
  }
  return counts;
}

void VolumeViewer::show_grid(const std::string& name) {
  const auto at = std::find(names_.begin(), names_.end(), name);
  if (at == names_.end())
    throw Error(ExitCode::usage,
                fmt::format("grid {}: {} has {}", name, file_.filename().string(), fmt::join(names_, ", ")));
  take_grid(size_t(at - names_.begin()));
}

void VolumeViewer::next_grid(int by) { take_grid((grid_ + names_.size() + size_t(by)) % names_.size()); }

void VolumeViewer::show_channel(const std::string& channel) {
  scalars_ = scalars_of(field_, channel);  // refuses what is not there
  look_.channel = channel;
  ++changes_;
  suit_range();
}

void VolumeViewer::next_channel() {
  const auto names = channels_of(field_.kind);
  const size_t at = size_t(std::find(names.begin(), names.end(), look_.channel) - names.begin());
  show_channel(names[(at + 1) % names.size()]);
}

void VolumeViewer::set_map(VolumeMap map) {
  if (map == VolumeMap::colour && look_.channel != "all")
    throw Error(ExitCode::usage, "colours as they are need the channel all, and this is " + look_.channel);
  look_.map = map;
}

void VolumeViewer::set_range(double low, double high) {
  if (!(high > low) || !std::isfinite(high - low))
    throw Error(ExitCode::usage, fmt::format("range {:g},{:g}: the second has to be larger", low, high));
  look_.low = low;
  look_.high = high;
}

void VolumeViewer::whole_range() {
  look_.low = scalars_.low;
  look_.high = scalars_.high > scalars_.low ? scalars_.high : scalars_.low + 1.0;
}

void VolumeViewer::suit_range() { volgi::suit_range(field_, scalars_, look_); }

void VolumeViewer::set_direction(glm::vec2 deg) {
  if (bands_.empty())
    throw Error(ExitCode::usage, "direction: this file has no spherical harmonics (sh_00, sh_1m1, sh_10, sh_11)");
  direction_deg_ = {std::remainder(deg.x, 360.0f), std::clamp(deg.y, -90.0f, 90.0f)};
  if (!shows_radiance()) return take_grid(names_.size() - 1);
  take_radiance();  // in the range that it has: directions compare
  take_scalars();
}

glm::ivec3 VolumeViewer::cell() const {
  return glm::ivec3(field_.first.x(), field_.first.y(), field_.first.z()) + field_.step * look_.cell;
}

void VolumeViewer::set_cell(glm::ivec3 index) {
  const glm::ivec3 first(field_.first.x(), field_.first.y(), field_.first.z()), from_first = index - first;
  const glm::ivec3 of_field = from_first / field_.step;
  if (glm::any(glm::lessThan(from_first, glm::ivec3(0))) || !field_.contains(of_field)) {
    const glm::ivec3 last = first + field_.step * field_.cells - 1;
    throw Error(ExitCode::usage, fmt::format("cell {},{},{}: {} has cells from {},{},{} to {},{},{}", index.x, index.y,
                                             index.z, field_.name, first.x, first.y, first.z, last.x, last.y, last.z));
  }
  look_.cell = of_field;
}

void VolumeViewer::move_cell(glm::ivec3 by) {
  look_.cell = glm::clamp(look_.cell + by, glm::ivec3(0), field_.cells - 1);
}

void VolumeViewer::set_view(const std::string& view) { look_.parts = parts_of(view); }

void VolumeViewer::orbit(double yaw_deg, double pitch_deg) {
  look_.yaw_deg = std::remainder(look_.yaw_deg + yaw_deg, 360.0);
  look_.pitch_deg = std::clamp(look_.pitch_deg + pitch_deg, -90.0, 90.0);
}

void VolumeViewer::zoom(double factor) {
  constexpr double LEAST = 0.2, MOST = 50.0;
  if (!(factor > 0.0)) throw Error(ExitCode::usage, fmt::format("zoom {:g}: a factor above 0", factor));
  look_.zoom = std::clamp(look_.zoom * factor, LEAST, MOST);
}

void VolumeViewer::reset_orbit() {
  const VolumeLook fresh;
  look_.yaw_deg = fresh.yaw_deg;
  look_.pitch_deg = fresh.pitch_deg;
  look_.zoom = fresh.zoom;
}

void VolumeViewer::want_screenshot(const std::string& name) {
  if (!name.empty()) {
    wanted_ = name;
    wanted_->replace_extension(".png");
    return;
  }
  for (int k = 1; !wanted_ || std::filesystem::exists(*wanted_); ++k)
    wanted_ = picture_folder / fmt::format("{}-{:03}.png", file_.stem().string(), k);
}

const Image& VolumeViewer::picture(glm::ivec2 size, bool quick) {
  const std::string what =
      fmt::format("{} {} {} {} {} {} {} {} {} {} {},{},{} {} {} {} {}", size.x, size.y, quick, changes_, look_.channel,
                  int(look_.map), look_.low, look_.high, look_.logarithmic, look_.cut, look_.cell.x, look_.cell.y,
                  look_.cell.z, look_.yaw_deg, look_.pitch_deg, look_.zoom, view());
  if (what == drawn_) return picture_;
  picture_ = volume_picture(field_, scalars_, look_, quick ? glm::max(size / 2, 1) : size);
  drawn_ = what;
  return picture_;
}

}  // namespace volgi::demo
