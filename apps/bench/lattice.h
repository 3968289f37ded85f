#pragma once
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/gl/context.h"
#include "core/scene.h"

namespace volgi::app {

struct LatticeBenchOptions {
  std::vector<std::string> scenes;       // of the tables of recipes; none: cornell, room, thin_wall and occluder
  std::string swept = "cornell";         // of angles, shells and the share of lights that are on
  std::string mapped = "atrium_detail";  // of the times of maps: 98,028 triangles
  int size = 192;                        // pixels on each side
  int frames = 3;
  std::filesystem::path references;  // folder of path-traced pictures of all bounces, NAME.exr, of that size
};

/// The wave lattice: what its ways of power, depth and visibility are worth beside as many virtual point lights; error
/// and time against angles, shells and the share of lights that are on; and the time of imperfect maps of 1024 lights
/// against as many regular ones. Errors are of all indirect light, noise removed, region noedge.
nlohmann::json bench_lattice(const std::function<Scene(const std::string&)>& scene, const gl::Context& context,
                             const LatticeBenchOptions& options, const std::function<void(const std::string&)>& show);

}  // namespace volgi::app
