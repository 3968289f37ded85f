#include "apps/demo/view.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "core/error.h"
#include "screen/base/virtual_light_list_gl.h"
#include "screen/bounces/volume/frame_volume.h"
#include "screen/gather/multires/light_tree.h"
#include "screen/visibility/area_maps/light_clusters.h"
#include "screen/visibility/negative/negative_lights.h"

namespace volgi::demo {

namespace {

using screen::LightPath;
using screen::LightPaths;

constexpr std::array VIEWS = {
    ViewInfo{View::picture, "picture", "Picture", "1", "all light, tone mapped: what `volgi render` writes"},
    ViewInfo{View::direct, "direct", "Direct light", "2",
             "light straight from lamps, sky and emissive surfaces, and emission that the camera sees"},
    ViewInfo{View::first_bounce, "first_bounce", "First bounce", "3", "light after one reflection"},
    ViewInfo{View::higher_bounces, "higher_bounces", "Higher bounces", "4", "light after two reflections and more"},
    ViewInfo{View::emission, "emission", "Emission", "5", "what surfaces and sky send to the camera themselves"},
    ViewInfo{View::albedo, "albedo", "Albedo", "6", "share of even light that surfaces send back, by colour"},
    ViewInfo{View::normals, "normals", "Normals", "7", "shading normals: red +X, green +Y, blue +Z of the world"},
    ViewInfo{View::depth, "depth", "Depth", "8", "distance along the view axis; a line for each step of it"},
    ViewInfo{View::voxels, "voxels", "Voxels", "9",
             "the volume's sides, on the cells that see them, with the irradiance that they receive"},
    ViewInfo{View::coverage, "coverage", "Coverage of sides", "0",
             "share of a face that its surface stops: dark little, bright all of it"},
    ViewInfo{View::lobe, "lobe", "Lobe of a cell", "Shift+1",
             "radiance in all directions in the cell under the cursor, as spherical harmonics"},
    ViewInfo{View::lights, "lights", "Virtual lights", "Shift+2", "a disk for each, its area by flux"},
    ViewInfo{View::clusters, "clusters", "Clusters", "Shift+3",
             "virtual lights in the colours of their clusters, and the clusters' rectangles"},
    ViewInfo{View::cluster_maps, "cluster_maps", "Cluster's depth map", "Shift+4",
             "distance that a cluster sees over its half space; keys [ and ] go through them"},
    ViewInfo{View::negative_lights, "negative_lights", "Negative lights", "Shift+5",
             "places that take light away, a ring for each"},
    ViewInfo{View::low_resolution, "low_resolution", "Gathered again", "Shift+6",
             "which pixels neighbours did not say enough of: those gathered themselves, or the error estimated"},
    ViewInfo{View::texture, "texture", "Texture", "Shift+7", "any texture that a pass has written"},
    ViewInfo{
        View::light_tree, "light_tree", "Light tree", "Shift+8",
        "nodes of one level in the colours of their clusters; keys [ and ] go through the levels, from the smallest"},
};

template <class T>
std::string missing(const screen::Frame& frame, const char* who) {
  return frame.products().find<T>() != nullptr ? std::string() : std::string(who);
}

/// A layer that holds light of the view and other light as well.
std::string mixed_light(LightPaths paths, const screen::Frame& frame) {
  bool some = false;
  for (const screen::RadianceLayer& layer : frame.layers()) {
    if (!layer.paths.meets(paths & frame.wanted())) continue;
    some = true;
    const LightPaths others = (layer.paths & frame.wanted()) - paths;
    if (!others.empty()) return "this recipe sums it with " + in_words(others);
  }
  return some ? std::string() : "there is no such light in this scene, or this recipe carries none";
}

}  // namespace

std::span<const ViewInfo> views() { return VIEWS; }
const ViewInfo& info(View view) { return VIEWS[size_t(view)]; }

View view_of(std::string_view name) {
  std::vector<std::string> known;
  for (const ViewInfo& v : VIEWS) {
    if (name == v.name) return v.view;
    known.emplace_back(v.name);
  }
  throw Error(ExitCode::usage, fmt::format("no view '{}'; there are {}", name, fmt::join(known, ", ")));
}

std::optional<LightPaths> paths_of(View view) {
  switch (view) {
    case View::picture:
      return LightPaths::all();
    case View::direct:
      return screen::DIRECT_PATHS;
    case View::first_bounce:
      return LightPaths{LightPath::punctual_first, LightPath::emission_first, LightPath::sky_first};
    case View::higher_bounces:
      return LightPaths{LightPath::punctual_higher, LightPath::emission_higher, LightPath::sky_higher};
    case View::emission:
      return LightPaths{LightPath::emission_seen, LightPath::sky_seen};
    default:
      return std::nullopt;
  }
}

std::string why_not(View view, const screen::Frame& frame) {
  if (view == View::picture || frame.layers().empty()) return {};
  if (const auto paths = paths_of(view)) return mixed_light(*paths, frame);
  switch (view) {
    case View::voxels:
    case View::coverage:
    case View::lobe:
      return missing<screen::FrameVolume>(frame, "no volume in this recipe");
    case View::lights:
      return missing<screen::VirtualLightListGl>(frame, "no virtual lights in this recipe");
    case View::clusters:
    case View::cluster_maps:
      return missing<screen::LightClusters>(frame, "no clusters in this recipe; hybrid and val have some");
    case View::light_tree:
      return missing<screen::LightTree>(frame, "no light tree in this recipe and with these options; hybrid has one");
    case View::negative_lights:
      return missing<screen::NegativeLights>(frame, "no negative lights in this recipe; --gi negative has some");
    default:
      return {};
  }
}

}  // namespace volgi::demo
