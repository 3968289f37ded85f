#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "core/gl/context.h"
#include "core/scene.h"

namespace volgi::app {

struct SplitOptions {
  int size = 96;                // pixels on each side
  int reference_spp = 1024;     // of the references of all bounces and of one
  std::filesystem::path cache;  // folder of cached_reference()
};

/// Where the error of `--gi hybrid` is: indirect light of all bounces at the scene's default quality, and what is left
/// of its error when one term after the other is switched to exact, the rest staying as it is. Errors as Yardstick has
/// them. Terms of the first bounce:
/// - lights: exact visibility (rays to every light) of the picture's own lights, and of 16 times as many;
/// - visibility: rays for maps; of the same rays, without what hides within four of a light's radii of the
///   receiver, or of the light: what an error there costs;
/// - clusters, maps: more of them, as many as there may be; interpolation: every pixel gathered;
/// of the bounces after it: side flux (16 times the rays), cells (twice as many), angles (512 directions), read-out
/// (rays from pixels to sides in place of the cells around a pixel). And the first bounce, or the later ones, path
/// traced.
/// Cost: two references, once (cache), and some ten pictures.
nlohmann::json bench_split(const Scene& scene, const gl::Context& context, const SplitOptions& options);
std::string split_table(const nlohmann::json& result);

}  // namespace volgi::app
