#pragma once
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "apps/demo/keys.h"
#include "voxel/vdb_file.h"
#include "voxel/volume_view.h"

namespace volgi::demo {

/// By its name: .vdb, in any case.
bool is_volume_file(const std::filesystem::path& file);

/// A volume that is open, and how it is looked at.
class VolumeViewer {
 public:
  /// @throws Error as read_vdb; Error(bad_input) where no grid has active cells with numbers.
  explicit VolumeViewer(std::filesystem::path file);

  const std::filesystem::path& file() const { return file_; }
  /// Names of what can be looked at: the file's grids with numbers, and "radiance" where there are spherical harmonics.
  const std::vector<std::string>& grids() const { return names_; }
  const VolumeField& field() const { return field_; }
  const VolumeScalars& scalars() const { return scalars_; }
  const VolumeLook& look() const { return look_; }
  std::string view() const;  // "sheet", "x", "y", "z" or "orbit"
  bool shows_radiance() const { return bands_count() > 0 && grid_ == names_.size() - 1; }
  glm::vec2 direction_deg() const { return direction_deg_; }  // azimuth, height: what radiance travels towards
  /// Cells by value, in equal steps from the lowest to the highest.
  std::vector<float> histogram(int bins) const;

  // What changes the look. Arguments outside what there is are refused by Error(usage), which says what there is.
  void show_grid(const std::string& name);
  void next_grid(int by);
  void show_channel(const std::string& channel);
  void next_channel();
  void set_map(VolumeMap map);
  void set_range(double low, double high);
  void whole_range();
  void suit_range();
  void set_logarithmic(bool on) { look_.logarithmic = on; }
  void set_cut(bool on) { look_.cut = on; }
  void set_direction(glm::vec2 deg);  // of azimuth, heights are cut at the poles
  void set_cell(glm::ivec3 index);    // the grid's own
  void move_cell(glm::ivec3 by);      // within the box
  void choose_cell(glm::ivec3 of_field) { look_.cell = of_field; }
  glm::ivec3 cell() const;  // the grid's own index
  void set_view(const std::string& view);
  void orbit(double yaw_deg, double pitch_deg);
  void zoom(double factor);
  void reset_orbit();

  /// Kept until something has changed. `quick`: half as many pixels each way, for while it is turned.
  const Image& picture(glm::ivec2 size, bool quick = false);

  /// For whoever draws: a picture as it is shown, to this file. @param name  empty: the volume's and a number.
  void want_screenshot(const std::string& name);
  std::optional<std::filesystem::path> take_screenshot() { return std::exchange(wanted_, std::nullopt); }

  std::filesystem::path picture_folder = ".";
  bool asked_to_quit = false, panel_shown = true, help_shown = false;
  std::string message;  // the last one

 private:
  struct Grid {
    openvdb::GridBase::Ptr grid;
    GridSummary summary;
  };
  size_t bands_count() const { return bands_.size(); }
  void find_bands();
  void take_grid(size_t number);
  void take_scalars();
  void take_radiance();

  std::filesystem::path file_;
  std::vector<Grid> file_grids_;
  std::vector<size_t> bands_;  // of spherical harmonics, among them: 4, 9 or none
  std::vector<VolumeField> band_fields_;
  std::vector<std::string> names_;
  size_t grid_ = 0;
  VolumeField field_;
  VolumeScalars scalars_;
  VolumeLook look_;
  glm::vec2 direction_deg_{0.0f};

  std::optional<std::filesystem::path> wanted_;
  Image picture_;
  std::string drawn_;  // what the picture is of
  int changes_ = 0;    // of field_ and scalars_
};

/// What a person can do with a volume, as a line of text; as Command is for scenes.
struct VolumeCommand {
  const char* name;
  const char* arguments;
  const char* help;
  void (*run)(VolumeViewer& viewer, const std::string& arguments);
};
std::span<const VolumeCommand> volume_commands();
std::span<const KeyBinding> volume_key_bindings();

/// @throws Error(usage) for a command that there is not, or arguments that it does not take.
void execute(VolumeViewer& viewer, std::string_view line);

}  // namespace volgi::demo
