#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "core/gl/context.h"
#include "core/scene.h"

namespace volgi::app {

/// Tables 1 and 2 of Cochran and Steele 2007 in our form, beside theirs: time of a frame against the numbers of virtual
/// and negative lights; time and error against the share of pixels whose light comes from coarse ones. Pixels 640 x
/// 480, first-order light alone. Errors are of the indirect light, in percent of full range (of the brightest pixel).
nlohmann::json bench_cochran2007(const Scene& scene, const gl::Context& context, int frames);
std::string cochran2007_table(const nlohmann::json& results);

}  // namespace volgi::app
