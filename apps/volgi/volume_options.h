#pragma once
#include <optional>
#include <string>
#include <vector>

#include "propagation/volume_options.h"

namespace CLI {
class App;
}

namespace volgi::app {

/// What every command that makes a volume takes: --grid, --bounds, --scheme, --sh-order, --directions, --bounces,
/// --iterations, --first-light, --memory-limit, --threads.
struct VolumeCommandOptions {
  std::string scheme = "ordinates", first_light = "auto";
  std::optional<int> bounces, iterations, directions, threads;
  int sh_order = 1;
  std::optional<int> grid_cells;
  std::vector<double> bounds;  // two corners in the file's frame [m]
  std::string memory_limit;    // bytes, with K, M or G
  std::optional<int> cascades;
  std::vector<std::string> cascade;  // boxes, X0,Y0,Z0,X1,Y1,Z1 in the file's frame [m]
  int cascade_ratio = 2;

  void add_to(CLI::App& command);
  /// --cascades, --cascade and --cascade-ratio, of commands that make pictures.
  void add_cascades_to(CLI::App& command);
  /// Whether anything but threads was asked for.
  bool given() const;
  /// @throws Error(usage) for options that do not go together.
  VolumeOptions volume_options() const;
  /// Puts nested grids around the camera or where --cascade says, and the grid's box around --bounds; without it around
  /// what the camera (if there is one) and lamps reach (reached_box()), where that is less than half as long as the
  /// scene, and says so.
  /// @return what they reach. @throws Error(usage) for bounds that no part of the scene is in.
  std::optional<GridBox> fit_box(const Scene& scene, const std::optional<glm::vec3>& eye, VolumeOptions& options) const;
  /// The same without a camera, and where --grid is not given cells that suit the box (automatic_grid_cells()).
  void fit_grid(const Scene& scene, VolumeOptions& options) const;
  /// Limits the number of threads from here on (--threads); for the life of the program.
  void limit_threads() const;
};

/// Warns where what is seen is hardly higher than a cell.
void warn_of_large_cells(const Scene& scene, const GridBox& reached, const VolumeOptions& options);

/// Name of a scheme on the command line. @throws Error(usage) for another name, naming those that there are.
Scheme scheme_from_name(const std::string& name);
const char* scheme_name(Scheme scheme);

}  // namespace volgi::app
