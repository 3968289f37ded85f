#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "core/gl/context.h"
#include "core/scene.h"

namespace volgi::app {

struct AgainstPathTracingOptions {
  int size = 512;  // pixels on each side
  int frames = 5;  // of hybrid, measured before the path tracer and as many after it
  int reference_spp = 1024;
  int max_spp = 4096;           // where the path tracer gives up
  std::filesystem::path cache;  // folder of cached_reference()
};

/// How long the path tracer takes to the error that `--gi hybrid` has at its defaults, over the time of hybrid's frame.
/// Error: RMSE of indirect light of all bounces, region noedge, against path tracing with another seed, whose own noise
/// is taken out. The path tracer's samples double until its error is below; between the last two of its points the
/// curve is a straight line in logarithms. Its acceleration structure is built beforehand, as hybrid's scene is
/// uploaded; both make direct light as well. Cost: mostly that of the reference, size² · reference_spp paths, once.
nlohmann::json bench_against_path_tracing(const Scene& scene, const gl::Context& context,
                                          const AgainstPathTracingOptions& options);
std::string against_path_tracing_table(const nlohmann::json& result);

}  // namespace volgi::app
