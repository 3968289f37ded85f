#pragma once
#include <optional>
#include <span>
#include <string_view>

#include "screen/frame/frame.h"
#include "screen/frame/light_path.h"

namespace volgi::demo {

/// What the window can show of a frame.
enum class View {
  picture,
  direct,
  first_bounce,
  higher_bounces,
  emission,
  albedo,
  normals,
  depth,
  voxels,
  coverage,
  lobe,
  lights,
  clusters,
  cluster_maps,
  negative_lights,
  low_resolution,
  texture,
  light_tree,
};

struct ViewInfo {
  View view;
  const char* name;   // of settings, --view and the command line of the window
  const char* title;  // in menus
  const char* key;    // as it is shown: "1", "Shift+1"
  const char* help;   // how to read it
};
/// In the order of View.
std::span<const ViewInfo> views();
const ViewInfo& info(View view);
/// @throws Error(usage) naming those that there are.
View view_of(std::string_view name);

/// Light that a view sums; none for those that show something else.
std::optional<screen::LightPaths> paths_of(View view);
/// Why a view has nothing to show, or cannot show it alone; empty where it can.
std::string why_not(View view, const screen::Frame& frame);

}  // namespace volgi::demo
