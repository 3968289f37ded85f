// What a grid's place, a scene's orientation, its unit and its lights' strength must not change, for whole frames
// (docs/hard-cases.md: "shift", "rotate"; "scale", "offset" and "range" where invariance_test.cpp and
// first_bounce_test.cpp do not look).
#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <string>
#include <tuple>

#include "reference/path_tracer.h"
#include "tests/hardcases/frame_case.h"
#include "tests/support/frame_picture.h"
#include "tests/support/gl_test.h"
#include "tests/support/invariance.h"
#include "tests/support/paths.h"
#include "tests/support/turned.h"
#include "tests/support/volume_scenes.h"

namespace volgi::test {
namespace {

using screen::LightPart;

std::filesystem::path file(const std::string& name) { return source_dir() / "data" / (name + ".glb"); }

/// By 90 degrees about an axis.
Scene quarter_turned(const Scene& scene, int axis) {
  glm::vec3 about(0.0f);
  about[axis] = 1.0f;
  glm::mat3 turn = rotation(about, 90.0f);
  for (int i = 0; i < 3; ++i) turn[i] = glm::round(turn[i]);
  return turned(scene, turn);
}

class Moved : public GlTest {
 protected:
  static screen::FrameOptions options(Gi gi, int cells, Scheme scheme = Scheme::ordinates) {
    screen::FrameOptions o = picture_options(gi, {64, 64});
    o.of<VolumeOptions>().grid_cells = cells;
    o.of<VolumeOptions>().scheme.scheme = scheme;
    return o;
  }
  static Image picture(const Scene& scene, const screen::FrameOptions& o) {
    return render(context(), scene, scene.cameras.at(0), o).image;
  }
};

struct Case {
  const char* scene;
  Gi gi;
  Scheme scheme;
  int cells;
  std::array<double, 3> limits_percent;  // each test says of what
  TestedOn where = TestedOn::both;

  std::string figure() const {
    return fmt::format("{}{}, {}, {} cells", gi, scheme == Scheme::conservative ? " conservative" : "", scene, cells);
  }
  std::string name() const {
    const char* gi_name = gi == Gi("volume") ? "Volume" : gi == Gi("vpl") ? "Vpl" : gi == Gi("val") ? "Val" : "Hybrid";
    const char* scheme_name = scheme == Scheme::conservative ? "Conservative" : "";
    return scene + std::to_string(cells) + gi_name + scheme_name + name_ending(where);
  }
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.name(); }

/// One case a test, so that what a backend leaves out is seen to be skipped.
class MovedCase : public Moved, public testing::WithParamInterface<Case> {
 protected:
  void SetUp() override {
    Moved::SetUp();
    if (IsSkipped()) return;
    if (const char* reason = reason_to_skip(GetParam().where, context())) GTEST_SKIP() << reason;
  }
  const Scene scene_ = load_scene(file(GetParam().scene));
  screen::FrameOptions options_ = options(GetParam().gi, GetParam().cells, GetParam().scheme);
};

constexpr const char* ROUNDED =
    "which candidates become lights, and which a cluster, hangs on sums that rounding decides";

class ShiftedGrid : public MovedCase {};
class TurnedScene : public MovedCase {};
class AreaLightsIn : public MovedCase {};

// Limits: of shifts by a quarter and by half a cell.
TEST_P(ShiftedGrid, ShowsAsMuchLight) {
  options_.light = LightPart::indirect;
  const double still = mean_light(picture(scene_, options_));
  for (int k = 0; k < 2; ++k) {
    const float shift = k == 0 ? 0.25f : 0.5f;
    options_.of<VolumeOptions>().grid_shift_cells = {shift, -shift, 0.5f * shift};
    const double percent = 100.0 * mean_light(picture(scene_, options_)) / still;
    const double limit = GetParam().limits_percent[size_t(k)];
    expect_of_frame("shift", fmt::format("{}, by {}", GetParam().figure(), shift), std::abs(percent - 100.0), limit,
                    3.0, limit > 3.0 ? "not found: ordinates move by 1.4 % on the same grids" : "");
  }
}

// 3 % is the limit; room by `conservative` misses it, and so do coarser grids (docs/results/where-we-miss.md).
INSTANTIATE_TEST_SUITE_P(
    Moved, ShiftedGrid,
    testing::Values(Case{"cornell", Gi("volume"), Scheme::ordinates, 20, {3.0, 3.0}},
                    Case{"cornell", Gi("volume"), Scheme::conservative, 16, {3.0, 3.0}, TestedOn::not_in_software},
                    Case{"cornell", Gi("hybrid"), Scheme::ordinates, 20, {3.0, 3.0}},
                    Case{"room", Gi("volume"), Scheme::ordinates, 32, {3.0, 3.0}, TestedOn::not_in_software},
                    Case{"room", Gi("hybrid"), Scheme::ordinates, 32, {3.0, 3.0}, TestedOn::not_in_software},
                    Case{"room", Gi("volume"), Scheme::conservative, 32, {3.0, 20.5}, TestedOn::not_in_software}),
    [](const auto& test) { return test.param.name(); });

// Limits: of turns about X, Y and Z.
TEST_P(TurnedScene, LooksTheSame) {
  // Room's patch of sun has edges, where a few pixels are 8 % of all direct light.
  if (GetParam().scene == std::string("room")) options_.light = LightPart::indirect;
  const Image ref = picture(scene_, options_);
  for (int axis = 0; axis < 3; ++axis) {
    const double deviation = rmse_percent(picture(quarter_turned(scene_, axis), options_), ref);
    const double limit = GetParam().limits_percent[size_t(axis)];
    const bool by_lights = GetParam().gi != Gi("volume");
    expect_of_frame(
        "rotate", fmt::format("scene: {}, about {}", GetParam().figure(), "XYZ"[axis]), deviation, limit, 1.0,
        limit <= 1.0 ? ""
        : by_lights  ? "virtual lights are laid out from the world's axes: after a turn they are other samples"
                     : "surfaces on cells' centres: a tie moves a wall by a cell");
  }
}

// 1 % is the limit. The volume holds it where no surface lies on a cell's centre. Virtual lights are other samples of
// the same surface once their lamp turns about its own axis, which is Y (docs/results/where-we-miss.md).
INSTANTIATE_TEST_SUITE_P(
    Moved, TurnedScene,
    testing::Values(Case{"cornell", Gi("volume"), Scheme::ordinates, 16, {1.0, 1.0, 1.0}},
                    Case{"cornell", Gi("volume"), Scheme::conservative, 16, {1.0, 1.0, 1.0}, TestedOn::not_in_software},
                    Case{"room", Gi("volume"), Scheme::ordinates, 21, {2.0, 1.0, 1.0}, TestedOn::not_in_software},
                    Case{"cornell", Gi("vpl"), Scheme::ordinates, 16, {1.1, 3.0, 1.0}, TestedOn::gpu_only},
                    Case{"cornell", Gi("val"), Scheme::ordinates, 16, {1.0, 7.6, 1.0}, TestedOn::gpu_only},
                    Case{"cornell", Gi("hybrid"), Scheme::ordinates, 16, {1.0, 5.6, 1.0}}),
    [](const auto& test) { return test.param.name(); });

// Walls that are turned a little against the grid are long stairs (docs/theory.md#sides). The lamp makes their own
// light count for more than what comes from elsewhere. The picture is the same at every angle, and so is the path
// tracer's.
class SlightlyTurnedWalls : public Moved {
 protected:
  static void expect_errors_below(int cells, const std::array<double, 5>& limits);
};

void SlightlyTurnedWalls::expect_errors_below(int cells, const std::array<double, 5>& limits) {
  Scene upright;
  const int grey = add_material(upright, glm::vec3(0.7f)), blue = add_material(upright, {0.2f, 0.35f, 0.65f});
  add_box_inside(upright, grey, glm::vec3(0.0f), {1.0f, 0.75f, 1.0f});
  add_box_inside(upright, blue, {-0.3f, -0.3f, -0.2f}, {0.25f, 0.45f, 0.25f});  // its sides reflect both ways
  upright.lights.push_back(spot_light({0.7f, 0.6f, 0.8f}, {-0.6f, -0.7f, -0.6f}, 20.0f, 40.0f, glm::vec3(5.0f)));
  upright.cameras.push_back(
      look_at_camera({0.8f, 0.3f, 0.6f}, {-0.3f, -0.2f, -0.2f}, 1.0f, upright.bounds_min, upright.bounds_max));
  PathTracerOptions paths;
  paths.size = {64, 64};
  paths.samples_per_pixel = 256;
  paths.light = PathTracerOptions::Light::indirect;
  const Image ref = path_trace(upright, upright.cameras.at(0), paths).color;
  size_t k = 0;
  for (float angle_deg : {0.0f, 3.0f, 6.0f, 10.0f, 25.0f}) {
    const Scene scene = turned(upright, rotation({0, 1, 0}, angle_deg));
    screen::FrameOptions o = options(Gi("volume"), cells);
    o.light = LightPart::indirect;
    const double error = rmse_percent(picture(scene, o), ref);
    EXPECT_LT(error, limits[k++]) << angle_deg << " degrees";
    RecordProperty("turned_" + std::to_string(int(angle_deg)), std::to_string(error));
  }
}

TEST_F(SlightlyTurnedWalls, In32Cells) { expect_errors_below(32, {6.4, 7.2, 8.8, 9.1, 10.0}); }
TEST_F(SlightlyTurnedWalls, In64CellsNotInSoftware) {
  if (const char* reason = reason_to_skip(TestedOn::not_in_software, context())) GTEST_SKIP() << reason;
  expect_errors_below(64, {5.6, 6.2, 6.9, 7.2, 6.5});
}

// Limits: of scale and of range. 0.1 % is asked for, and 1e-3 of every pixel. Which candidates become virtual lights,
// and which of them a cluster, hangs on sums that rounding decides: factors that do not round change nothing, others
// move a few lights (docs/results/where-we-miss.md).
TEST_P(AreaLightsIn, AnyScaleOffsetAndRange) {
  const Image ref = picture(scene_, options_);
  for (float s : {0x1p-10f, 0x1p10f}) EXPECT_LT(rmse_percent(picture(scaled(scene_, s), options_), ref), 0.1) << s;
  for (float s : {1e-3f, 1e3f}) {
    const double deviation = rmse_percent(picture(scaled(scene_, s), options_), ref);
    expect_of_frame("scale", fmt::format("{} x {:g}", GetParam().figure(), s), deviation, GetParam().limits_percent[0],
                    0.1, ROUNDED);
  }
  for (float factor : {0x1p-20f, 0x1p30f})
    EXPECT_LT(worst_deviation(picture(brighter(scene_, factor), options_), ref, double(factor)), 1e-3) << factor;
  for (float factor : {1e-6f, 1e9f}) {
    const double deviation = rmse_percent(picture(brighter(scene_, factor), options_), ref, double(factor));
    expect_of_frame("range", fmt::format("{} x {:g}, RMSE", GetParam().figure(), factor), deviation,
                    GetParam().limits_percent[1], 0.1, ROUNDED);
  }
  expect_of_frame("offset", GetParam().figure(),
                  rmse_percent(picture(load_moved(file(GetParam().scene), 1e5), options_), ref), 0.1);
}

INSTANTIATE_TEST_SUITE_P(
    Moved, AreaLightsIn,
    testing::Values(Case{"cornell", Gi("val"), Scheme::ordinates, 12, {1.3, 2.2}, TestedOn::gpu_only},
                    Case{"cornell", Gi("hybrid"), Scheme::ordinates, 12, {1.3, 2.2}},
                    Case{"emissive", Gi("val"), Scheme::ordinates, 12, {1.3, 2.2}, TestedOn::gpu_only},
                    Case{"emissive", Gi("hybrid"), Scheme::ordinates, 12, {1.3, 2.2}, TestedOn::not_in_software}),
    [](const auto& test) { return test.param.name(); });

}  // namespace
}  // namespace volgi::test
