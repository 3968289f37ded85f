// Rooms that are long, thin or flat (docs/hard-cases.md, "shape"): how far pictures of ducts are from paths, that boxes
// of 100:1:1 and scenes of one layer of cells show something sane, and that the twins agree on them. Flat scenes in
// files: flat_volume_test.cpp.
#include <gtest/gtest.h>

#include <string>

#include "propagation/crosscheck.h"
#include "reference/metrics.h"
#include "reference/path_tracer.h"
#include "tests/hardcases/frame_case.h"
#include "tests/support/frame_picture.h"
#include "tests/support/gl_test.h"
#include "tests/support/invariance.h"
#include "tests/support/volume_scenes.h"

namespace volgi::test {
namespace {

constexpr glm::ivec2 kSize{64, 64};

/// A closed room with a lamp in it, grey.
Scene room(glm::vec3 size, glm::vec3 lamp) {
  Scene scene;
  add_box_inside(scene, add_material(scene, glm::vec3(0.7f)), glm::vec3(0.0f), 0.5f * size);
  scene.lights.push_back(point_light(lamp, glm::vec3(1.0f)));
  return scene;
}

/// 1 m wide, along x; the lamp 0.6 m from its low end. A cube where it is as long as it is wide.
Scene duct(float length) { return room({length, 1.0f, 1.0f}, {0.6f - 0.5f * length, 0.1f, 0.05f}); }

Camera inside(const Scene& scene, glm::vec3 eye, glm::vec3 target) {
  return look_at_camera(eye, target, 1.3f, scene.bounds_min, scene.bounds_max);
}
/// 0.2 m from the end of a duct, looking along it.
Camera from_lit_end(const Scene& s) { return inside(s, {s.bounds_min.x + 0.2f, 0.03f, 0.02f}, {s.bounds_max.x, 0, 0}); }
Camera from_dark_end(const Scene& s) {
  return inside(s, {s.bounds_max.x - 0.2f, 0.03f, 0.02f}, {s.bounds_min.x, 0, 0});
}

/// All indirect light, by paths.
class Judge {
 public:
  Judge(const Scene& scene, const Camera& camera, int samples) {
    PathTracerOptions o;
    o.size = kSize;
    o.samples_per_pixel = samples;
    o.light = PathTracerOptions::Light::indirect;
    reference_ = path_trace(scene, camera, o);
    noise_ = reference_.half_a;
    for (size_t i = 0; i < noise_.pixels.size(); ++i)
      noise_.pixels[i] = 0.5f * (reference_.half_a.pixels[i] - reference_.half_b.pixels[i]);
  }
  Metrics::Relative operator()(const Image& image) const {
    const ReferencePicture& r = reference_;
    const Metrics m =
        measure(r.color, image, &noise_, region_mask(Region::noedge, {r.position, r.normal, r.direct, r.id, r.depth}));
    EXPECT_EQ(m.nonfinite, 0);
    EXPECT_EQ(m.negative, 0);
    return m.relative.value();
  }

 private:
  ReferencePicture reference_;
  Image noise_;
};

class Shape : public GlTest {
 protected:
  static screen::FrameOptions options(Gi gi, int cells, Scheme scheme = Scheme::ordinates) {
    screen::FrameOptions o = picture_options(gi, kSize, screen::LightPart::indirect);
    o.of<VolumeOptions>().grid_cells = cells;
    o.of<VolumeOptions>().scheme.scheme = scheme;
    return o;
  }
};

struct DuctCase {
  int width;               // cells
  double hybrid_percent;   // most error at the lit end; 0: twice the cube's
  double volume_percent;   // the same of `volume`
  glm::dvec2 hybrid_dark;  // energy at the dark end, 7 ... 8 widths from the lamp
  glm::dvec2 volume_dark;
};

// At the lit end, where most of the light is, a duct of four cells or more is as good as a cube of as many. Where
// little of it arrives the few directions of `ordinates` show, and there the limit is what was measured: of
// hybrid 1.91, 1.00, 1.29, 1.05 times the light for 1, 2, 4, 8 cells; of volume 2.15, 0.93, 1.39, 1.06; by both
// backends (docs/results/where-we-miss.md). Errors at the lit end: hybrid 12.5, 4.3, 2.2, 1.2 % (twice the cube's: 2.7
// and 2.1 for 4 and 8 cells), volume 23, 8.5, 3.1, 1.6 %.
TEST_F(Shape, Ducts) {
  const Scene cube = duct(1.0f), scene = duct(8.0f);
  const Camera lit_end = from_lit_end(scene), dark_end = from_dark_end(scene);
  // The noise of a pixel at the dark end is half of its light at 128 samples: its mean is all that counts, and that
  // errs by 1 % there.
  const Judge of_cube(cube, from_lit_end(cube), 64), of_lit(scene, lit_end, 64), of_dark(scene, dark_end, 1024);
  for (const DuctCase& c : {DuctCase{1, 13.0, 24.0, {1.7, 2.05}, {2.0, 2.25}},
                            {2, 4.6, 9.5, {0.77, 1.03}, {0.87, 0.98}},
                            {4, 0.0, 4.0, {1.05, 1.3}, {1.3, 1.45}},
                            {8, 0.0, 2.5, {0.85, 1.06}, {1.0, 1.1}}}) {
    for (Gi mode : {Gi("hybrid"), Gi("volume")}) {
      const std::string what = (mode == Gi("hybrid") ? "hybrid_" : "volume_") + std::to_string(c.width);
      screen::Frame frame(scene, options(mode, 8 * c.width));
      gl::PassTimer timer(context().software(), false);
      const auto seen_from = [&](const Camera& camera) {
        frame.render(camera, timer);
        return screen::image_from_texture(frame.radiance());
      };
      const double error = of_lit(seen_from(lit_end)).rmse_pct_denoised.value();
      double limit = mode == Gi("hybrid") ? c.hybrid_percent : c.volume_percent;
      if (limit == 0.0) {
        const Image image = render(context(), cube, from_lit_end(cube), options(mode, c.width)).image;
        limit = 2.0 * of_cube(image).rmse_pct_denoised.value();
      }
      const std::string figure = fmt::format("{}, a duct of {} cells", mode, c.width);
      if ((mode == Gi("hybrid") ? c.hybrid_percent : c.volume_percent) == 0.0) {
        expect_of_frame("shape", figure + ", lit end, error over the cube's", 2.0 * error / limit, 2.0, {}, {},
                        "times");
      } else {
        expect_of_frame("shape", figure + ", lit end, error", error, limit);
      }
      const double energy = of_dark(seen_from(dark_end)).ratio;
      const glm::dvec2 bounds = mode == Gi("hybrid") ? c.hybrid_dark : c.volume_dark;
      EXPECT_GT(energy, bounds[0]) << what;
      EXPECT_LT(energy, bounds[1]) << what;
      EXPECT_EQ(frame.report().of<screen::VolumeReport>().grid, glm::ivec3(8 * c.width, c.width, c.width));
      expect_of_frame("shape", figure + ", dark end, energy", off_percent(energy),
                      100.0 * std::max(bounds[1] - 1.0, 1.0 - bounds[0]));
    }
  }
}

// Cells are three times as wide as the box. Nothing but sanity is asked for: seven widths from the lamp `hybrid` is 3.5
// times too bright, with 256 cells along the box, which are three across, 1.4 times. Turned boxes look the same, but
// for the few virtual lights that 130 sides see on the CPU.
TEST_F(Shape, BoxesOfAHundredToOne) {
  for (const auto& [mode, scheme, tolerance] : {std::tuple(Gi("hybrid"), Scheme::ordinates, 0.15),
                                                {Gi("volume"), Scheme::ordinates, 1e-3},
                                                {Gi("volume"), Scheme::conservative, 1e-3}}) {
    double first = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
      glm::vec3 size(1.0f), eye(0.1f), target(0.0f);
      size[axis] = 100.0f;
      eye[axis] = 2.0f;
      target[axis] = 40.0f;
      const Scene scene = room(size, glm::vec3(0.05f));
      const Rendered r = render(context(), scene, inside(scene, eye, target), options(mode, 32, scheme));
      EXPECT_EQ(r.report.of<screen::VolumeReport>().grid[axis], 32);
      EXPECT_EQ(r.report.of<screen::VolumeReport>().sides, 4u * 32u + 2u);
      EXPECT_EQ(r.report.of<screen::VolumeReport>().lost, glm::vec3(0.0f));
      const double mean = mean_light(r.image);
      if (axis == 0) first = mean;
      EXPECT_GT(mean, 0.01);
      EXPECT_NEAR(mean / first, 1.0, tolerance) << axis;
    }
  }
}

// A plane does not light itself. The lobes of `conservative` widen as they go, and 8 % of its light come back
// (flat_volume_test.cpp).
TEST_F(Shape, FlatScenes) {
  for (int axis = 0; axis < 3; ++axis) {
    const Scene scene = square_across(axis);
    const Camera camera = framing_camera(scene.bounds_min, scene.bounds_max);
    screen::FrameOptions no_gi = options(Gi("none"), 16);
    no_gi.light = screen::LightPart::direct;
    const double direct = mean_light(render(context(), scene, camera, no_gi).image);
    EXPECT_GT(direct, 0.0);
    for (Scheme scheme : {Scheme::ordinates, Scheme::conservative}) {
      for (Gi mode : {Gi("hybrid"), Gi("volume")}) {
        const Rendered r = render(context(), scene, camera, options(mode, 16, scheme));
        glm::ivec3 cells(16);
        cells[axis] = 1;
        EXPECT_EQ(r.report.of<screen::VolumeReport>().grid, cells);
        EXPECT_EQ(r.report.of<screen::VolumeReport>().lost, glm::vec3(0.0f));
        const bool comes_back = mode == Gi("volume") && scheme == Scheme::conservative;
        EXPECT_LE(mean_light(r.image), comes_back ? 0.1 * direct : 0.0) << axis;
      }
    }
  }
}

TEST_F(Shape, TwinsAgreeOnGpuOnly) {
  if (tested_backend() == screen::Backend::cpu) GTEST_SKIP() << "both backends are in it";
  const Scene flat = square_across(1), rod = room({100, 1, 1}, glm::vec3(0.05f)),
              sheet = room({100, 1, 100}, {0.05f, 0.05f, 0.05f});
  for (Scheme scheme : {Scheme::ordinates, Scheme::conservative}) {
    for (const Scene* scene : {&flat, &rod, &sheet}) {
      for (const CrosscheckRow& r : crosscheck(*scene, options(Gi("volume"), 32, scheme).of<VolumeOptions>(), {1, 8}))
        EXPECT_TRUE(r.passed()) << r.stage << ": " << r.maximum << " (limit " << r.limit << ')';
    }
  }
}

}  // namespace
}  // namespace volgi::test
