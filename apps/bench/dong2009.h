#pragma once
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/gl/context.h"
#include "core/scene.h"

namespace volgi::app {

struct Dong2009Options {
  std::vector<std::string> scenes;  // of the table of times; none: the paper's in our form
  int size = 800;                   // pixels on each side
  int frames = 5;

  std::vector<std::string> curve_scenes;  // none: cornell, occluder and room
  int curve_size = 192;
  std::vector<int> curve_lights{256, 1024, 4096};
  std::filesystem::path one_bounce;  // folder of path-traced references of one bounce, NAME.exr
};

/// Tables 1 and 2 and figure 10 of Dong et al. 2009 in our form, beside theirs. Times: 1024 virtual point lights, 30
/// area lights, each step as the paper has them, for every shadow method; first-order light alone. Curve: error of the
/// indirect light against the number of area lights, gathered at every pixel, so that visibility alone is seen: against
/// the same lights with exact visibility, and against one bounce path traced where `one_bounce` has that picture in
/// this size. Region noedge, RMSE in percent of the mean.
/// @param show  gets each table as soon as it is measured.
nlohmann::json bench_dong2009(const std::function<Scene(const std::string&)>& scene_by_name, const gl::Context& context,
                              const Dong2009Options& options, const std::function<void(const std::string&)>& show);

/// The curve of one scene and number of lights, as bench_dong2009 has it. Cost: a gather of `lights` with exact
/// visibility, and a frame for each method and number of area lights.
nlohmann::json area_light_curve(const Scene& scene, const gl::Context& context, int lights,
                                const Dong2009Options& options);
std::string area_light_curve_table(const nlohmann::json& curve);

/// Shadow methods in the order of --set val.shadow, the default one first.
struct AreaLightShadowName {
  int number;  // of val.shadow
  const char* name;
};
inline constexpr AreaLightShadowName kAreaLightShadows[] = {
    {2, "one comparison"}, {0, "convolution"}, {1, "percentage-closer"}};

}  // namespace volgi::app
