#pragma once
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/camera.h"
#include "core/gl/context.h"
#include "core/image.h"
#include "core/scene.h"

namespace volgi::app {

/// What a renderer is to do; the same as on the command line of `volgi render` or `volgi reference`.
struct RenderTask {
  const Scene& scene;
  const Camera& camera;
  glm::ivec2 size;
  std::string light;  // full, indirect
  int frames;         // timed ones
  std::vector<std::string> options;
  gl::Context& context;
};

/// A picture and what it took.
struct Rendering {
  Image picture;                                 // of the last frame
  double min_ms = 0, median_ms = 0, max_ms = 0;  // a frame
  double cpu_ms = 0;  // processor time of a frame, all threads: what else runs does not change it. Median
  nlohmann::ordered_json passes = nlohmann::ordered_json::array();  // {"name", "ms"}: medians
  std::string timer;                                                // gpu or wall; empty: there are no times
  std::optional<size_t> memory_bytes;                               // of GL objects and volume; none: not known
};

using Renderer = std::function<Rendering(const RenderTask&)>;

/// Makers of pictures by the name of the command that makes the same one: "render" (screen::Frame) and "reference"
/// (the path tracer, its rays' tree built anew for each frame); and what reads those of other renderers
/// (added_picture.h). @throws Error(usage) for options that there are not.
std::map<std::string, Renderer> standard_renderers();

/// Finds out before hours of measuring that "render" or "reference" would refuse these options; knows nothing of
/// others.
/// @throws Error(usage).
void check_options(const std::string& renderer, const std::vector<std::string>& options);

/// Without --quality a technique is measured as its options have it by themselves, while `volgi render` chooses some of
/// them by the scene: what has to be added for the command to make the same picture.
std::vector<std::string> options_left_alone(const RenderTask& task);

/// Frames before the timed ones, as `volgi render --frames N` has them.
inline int warm_up_frames(int frames) { return frames > 1 ? 2 : 0; }

}  // namespace volgi::app
