#pragma once
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "core/gl/context.h"
#include "core/scene.h"

namespace volgi::app {

struct NicholsAreaBenchOptions {
  int size = 192;  // pixels on each side
  int frames = 3;
  std::filesystem::path data;  // with reference/scenes/area_tv.glb and reference/ref/area_tv, of that size
};

/// Nichols 2010, chapter 5, on area_tv: direct light of a textured screen without shadows, by incremental voxel
/// visibility, by blocked faces, and by 1024 coarse shadow maps, against Cycles (Fig. 5.8); pixels of each level and
/// time against the threshold (Fig. 5.9 and 5.10); size and depth of the voxels against exact rays to the same lights
/// (Fig. 5.11); numbers of lights and how they are placed (Fig. 5.14, 5.15). Region noedge, noise removed.
nlohmann::json bench_nichols2010_area(const gl::Context& context, const NicholsAreaBenchOptions& options,
                                      const std::function<void(const std::string&)>& show);

}  // namespace volgi::app
