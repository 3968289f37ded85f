#pragma once
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/gl/context.h"
#include "core/scene.h"

namespace volgi::app {

struct Nichols2010Options {
  std::vector<std::string> scenes;  // of tables 3.2 and 4.1; none: those of like kind
  std::vector<int> sizes{512, 1024};
  int error_size = 128;  // of pictures whose errors are measured
  int all_texels = 256;  // on a side of the light's map, all of which light in the yardstick
  int frames = 3;
  bool quick = false;  // one scene, small, one frame: tries the benchmark
};

/// Tables 3.1, 3.2 and 4.1 and figures 3.7, 3.8, 3.12, 4.5 and 4.9 to 4.13 of Nichols 2010 in our form, beside theirs:
/// multiresolution splatting and stencilled gathering, image-space radiosity and its hierarchy, as printed and without
/// visibility. Errors are RMSE in percent of the mean and of the brightest value of a gather of all texels of the
/// light's map at every pixel, which knows no visibility either: what the approximations cost, and not what the method
/// lacks.
/// @param show  gets each table as soon as it is measured.
nlohmann::json bench_nichols2010(const std::function<Scene(const std::string&)>& scene_by_name,
                                 const gl::Context& context, const Nichols2010Options& options,
                                 const std::function<void(const std::string&)>& show);

}  // namespace volgi::app
