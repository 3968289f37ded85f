#pragma once
// One picture through screen::Frame, for tests.
#include <cstdlib>
#include <string_view>
#include <vector>

#include "core/gl/context.h"
#include "core/gl/pass_timer.h"
#include "screen/base/image_from_texture.h"
#include "screen/bounces/volume/frame_volume.h"
#include "screen/frame/frame.h"
#include "screen/frame/registry.h"
#include "screen/gather/interleaved/area_light_gather.h"
#include "screen/gather/strided/virtual_light_gather.h"
#include "screen/lights/resample/resample_stage.h"
#include "screen/lights/rsm/virtual_lights.h"
#include "screen/visibility/area_maps/area_maps_stage.h"
#include "screen/visibility/area_maps/virtual_area_lights.h"
#include "screen/visibility/negative/negative_lights.h"

namespace volgi::test {

/// A name that --gi takes.
using Gi = std::string_view;

struct Rendered {
  Image image;
  screen::FrameReport report;
};

/// Tests of whole frames run once for each backend: ctest sets VOLGI_TEST_BACKEND (tests/hardcases/CMakeLists.txt).
inline screen::Backend tested_backend() {
  const char* name = std::getenv("VOLGI_TEST_BACKEND");
  return name != nullptr && std::string_view(name) == "cpu" ? screen::Backend::cpu : screen::Backend::gpu;
}

/// Where a test has something to say. One that skips elsewhere has it in its name, OnGpuOnly or NotInSoftware: `run`
/// takes every other skip of a test that needs OpenGL for a failure.
enum class TestedOn { both, gpu_only, not_in_software };
/// The reason to skip, for GTEST_SKIP; null where there is none.
inline const char* reason_to_skip(TestedOn where, const gl::Context& context) {
  const bool on_gpu = tested_backend() == screen::Backend::gpu;
  if (where == TestedOn::gpu_only && !on_gpu)
    return "no volume on the CPU in it: the other backend has tested the same passes";
  if (where == TestedOn::not_in_software && on_gpu && context.software())
    return "the GPU's volume would take minutes in software; the CPU's is tested";
  return nullptr;
}
inline const char* name_ending(TestedOn where) {
  return where == TestedOn::both ? "" : where == TestedOn::gpu_only ? "OnGpuOnly" : "NotInSoftware";
}

/// Small pictures by the tested backend.
inline screen::FrameOptions picture_options(Gi gi, glm::ivec2 size, screen::LightPart light = screen::LightPart::full) {
  screen::FrameOptions o;
  screen::apply_recipe(std::string(gi), o);  // with what its name stands for
  o.size = size;
  o.light = light;
  o.backend = tested_backend();
  return o;
}

inline Rendered render(const gl::Context& context, const Scene& scene, const Camera& camera,
                       screen::FrameOptions options) {
  options.backend = tested_backend();
  screen::Frame frame(scene, options);
  gl::PassTimer timer(context.software(), false);
  frame.render(camera, timer);
  return {screen::image_from_texture(frame.radiance()), frame.report()};
}

}  // namespace volgi::test
