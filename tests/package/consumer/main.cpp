#include <propagation/bounce_rules.h>
#include <reference/metrics.h>
#include <reference/path_tracer.h>
#include <voxel/grid.h>

#include <cmath>
#include <cstdio>

#include "one_triangle.h"

#ifdef CONSUMER_HAS_GL
float rasterized_spot(const volgi::Scene& scene, const volgi::Camera& camera);  // frame.cpp
#endif

namespace {

int failures = 0;

void expect_near(const char* what, double value, double expected, double tolerance) {
  const bool good = std::abs(value - expected) <= tolerance;
  std::printf("%s %s: %.6f, expected %.6f\n", good ? "ok  " : "FAIL", what, value, expected);
  failures += good ? 0 : 1;
}

}  // namespace

int main() {
  const volgi::Scene scene = one_triangle();
  const volgi::Camera camera = camera_at_spot(scene);

  const volgi::Grid grid = volgi::make_grid(scene, 4);
  expect_near("voxel: cells of a flat scene", double(volgi::cell_count(grid)), 16, 0);

  volgi::BounceRules rules;
  rules.largest_albedo = 0.5f;
  expect_near("propagation: absorption", rules.absorption(), 0.5, 1e-6);

  volgi::PathTracerOptions options;
  options.size = {3, 3};
  options.samples_per_pixel = 2;
  const volgi::ReferencePicture picture = volgi::path_trace(scene, camera, options);
  expect_near("reference: radiance under the light", picture.color.at(1, 1).y, 0.5, 1e-4);
  const volgi::Metrics same = volgi::measure(picture.color, picture.color, nullptr, volgi::Mask(9, 1));
  expect_near("reference: error of a picture to itself", same.max_absolute, 0, 0);

#ifdef CONSUMER_HAS_GL
  expect_near("screen: radiance under the light", rasterized_spot(scene, camera), 0.5, 2e-3);
#endif
  return failures == 0 ? 0 : 1;
}
