#include "apps/demo/camera_control.h"

#include <gtest/gtest.h>

#include <glm/gtc/constants.hpp>

namespace volgi::demo {
namespace {

constexpr glm::ivec2 SIZE(640, 360);
constexpr glm::vec3 LOW(-2, -1, -3), HIGH(2, 1.5f, 3);

Camera perspective() { return look_at_camera({3, 2, 6}, {0.5f, 0.2f, -1}, 0.8f, LOW, HIGH); }

Camera orthographic() {
  Camera camera = perspective();
  camera.kind = Camera::Kind::orthographic;
  camera.ymag = 2.5f;
  return with_depth_of(camera, LOW, HIGH);
}

Camera rolled(double roll_rad) {
  ViewAngles angles = view_angles(perspective());
  angles.roll_rad = roll_rad;
  return with_angles(perspective(), angles);
}

glm::vec3 eye(const Camera& c) { return glm::vec3(c.world_from_camera[3]); }
glm::vec3 back(const Camera& c) { return glm::vec3(c.world_from_camera[2]); }

/// Pixels, and depth 0 ... 1 between the planes in z.
glm::vec3 seen(const Camera& camera, glm::vec3 world) {
  const glm::vec4 clip = clip_from_camera(camera, SIZE) * camera_from_world(camera) * glm::vec4(world, 1.0f);
  const glm::vec3 n = glm::vec3(clip) / clip.w;
  return {(0.5f + 0.5f * n.x) * float(SIZE.x), (0.5f - 0.5f * n.y) * float(SIZE.y), n.z};
}
glm::vec2 pixel(const Camera& camera, glm::vec3 world) { return glm::vec2(seen(camera, world)); }

double worst_axis(const Camera& c) {
  const glm::dmat3 axes{glm::mat3(c.world_from_camera)};
  const glm::dmat3 product = glm::transpose(axes) * axes;
  double worst = std::abs(glm::determinant(axes) - 1.0);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) worst = std::max(worst, std::abs(product[i][j] - (i == j ? 1.0 : 0.0)));
  return worst;
}

TEST(CameraControl, AnglesMakeTheSameCamera) {
  for (const double roll : {0.0, 0.4, -2.9}) {
    for (const double yaw : {0.0, 1.2, -3.0}) {
      for (const double pitch : {0.0, 1.2, -1.5}) {
        const ViewAngles a = view_angles(with_angles(perspective(), {yaw, pitch, roll}));
        EXPECT_NEAR(a.yaw_rad, yaw, 1e-5);  // at a pitch of 1.5 a float's rounding is 14 times as large
        EXPECT_NEAR(a.pitch_rad, pitch, 2e-6);
        EXPECT_NEAR(a.roll_rad, roll, 1e-5);
      }
    }
  }
  EXPECT_NEAR(view_angles(perspective()).roll_rad, 0.0, 1e-6);
}

TEST(CameraControl, StraightDownHasARollOfNothing) {
  const Camera down = look_at_camera({0, 5, 0}, {0, 0, 0}, 0.8f, LOW, HIGH);
  const ViewAngles a = view_angles(down);
  EXPECT_NEAR(a.pitch_rad, -glm::half_pi<double>(), 1e-6);
  EXPECT_EQ(a.roll_rad, 0.0);
  const Camera again = with_angles(down, a);
  for (int k = 0; k < 3; ++k)
    EXPECT_LT(glm::distance(glm::vec3(again.world_from_camera[k]), glm::vec3(down.world_from_camera[k])), 1e-6f);
  // It can be turned back, and no steeper.
  EXPECT_NEAR(view_angles(orbited(down, {}, 0.0, -0.3)).pitch_rad, -glm::half_pi<double>(), 1e-6);
  EXPECT_NEAR(view_angles(orbited(down, {}, 0.0, 0.3)).pitch_rad, 0.3 - glm::half_pi<double>(), 1e-6);
}

TEST(CameraControl, OrbitKeepsThePivotInPlaceAndDistance) {
  const glm::vec3 pivot(0.3f, 0.8f, -0.5f);
  for (const Camera& camera : {perspective(), orthographic(), rolled(0.6)}) {
    const Camera turned = orbited(camera, pivot, 0.7, 0.2);
    EXPECT_NEAR(glm::distance(eye(turned), pivot), glm::distance(eye(camera), pivot), 1e-5);
    EXPECT_LT(glm::distance(pixel(turned, pivot), pixel(camera, pivot)), 1e-2f);
    EXPECT_NEAR(view_angles(turned).yaw_rad, view_angles(camera).yaw_rad + 0.7, 1e-6);
    EXPECT_NEAR(view_angles(turned).pitch_rad, view_angles(camera).pitch_rad + 0.2, 1e-6);
    EXPECT_NEAR(view_angles(turned).roll_rad, view_angles(camera).roll_rad, 1e-6);
  }
}

TEST(CameraControl, UpNeverFlips) {
  Camera camera = perspective();
  for (int step = 0; step < 400; ++step) {
    camera = orbited(camera, {0, 0, 0}, 0.05, step < 200 ? -0.1 : 0.1);
    EXPECT_GT(camera.world_from_camera[1].y, 0.0f);
    EXPECT_LE(std::abs(view_angles(camera).pitch_rad), STEEPEST_RAD + 1e-5);
  }
  EXPECT_NEAR(view_angles(camera).pitch_rad, STEEPEST_RAD, 1e-5);
}

TEST(CameraControl, AxesAndPivotSurviveTenThousandSteps) {
  const glm::vec3 pivot(0.3f, 0.8f, -0.5f);
  Camera camera = perspective();
  for (int step = 0; step < 10000; ++step) camera = orbited(camera, pivot, 0.013, step % 2 == 0 ? 0.02 : -0.02);
  EXPECT_LT(worst_axis(camera), 5e-7);  // roundings of one step to float
  EXPECT_NEAR(view_angles(camera).roll_rad, 0.0, 1e-6);
  // Each step rounds the eye once more, by 2.5e-7 at most: a random walk of 100 of those.
  EXPECT_NEAR(glm::distance(eye(camera), pivot), glm::distance(eye(perspective()), pivot), 1e-4);
}

TEST(CameraControl, PanMovesThePivotWithTheCursor) {
  const glm::vec3 pivot(0.3f, 0.8f, -0.5f);
  const glm::vec2 drag(37.0f, -21.0f);
  for (const Camera& camera : {perspective(), orthographic(), rolled(0.6)}) {
    const Camera moved = panned(camera, pivot, drag, SIZE);
    EXPECT_LT(glm::distance(pixel(moved, pivot), pixel(camera, pivot) + drag), 1e-2f);
    EXPECT_EQ(back(moved), back(camera));
  }
  // Behind the camera there is no picture plane: a way all the same.
  EXPECT_NE(eye(panned(perspective(), {9, 6, 20}, drag, SIZE)), eye(perspective()));
}

TEST(CameraControl, DollyKeepsThePivotUnderTheCursor) {
  const glm::vec3 pivot(0.3f, 0.8f, -0.5f);
  for (const double factor : {0.5, 0.9, 1.0, 1.25}) {
    const Camera near = dollied(perspective(), pivot, factor);
    EXPECT_NEAR(glm::distance(eye(near), pivot), factor * double(glm::distance(eye(perspective()), pivot)), 1e-5);
    EXPECT_LT(glm::distance(pixel(near, pivot), pixel(perspective(), pivot)), 1e-2f);
    const Camera flat = dollied(orthographic(), pivot, factor);
    EXPECT_NEAR(flat.ymag, factor * 2.5, 1e-6);
    EXPECT_LT(glm::distance(pixel(flat, pivot), pixel(orthographic(), pivot)), 1e-2f);
  }
}

TEST(CameraControl, DollyNeverArrives) {
  Camera camera = perspective(), flat = orthographic();
  for (int step = 0; step < 500; ++step) {
    camera = dollied(camera, {0, 0, 0}, 0.5);
    flat = dollied(flat, {0, 0, 0}, 0.5);
  }
  EXPECT_GT(glm::length(eye(camera)), 0.0f);
  EXPECT_GT(flat.ymag, 0.0f);
  EXPECT_LT(worst_axis(camera), 5e-7);
}

TEST(CameraControl, FlightGoesAlongTheCamerasOwnAxes) {
  for (const Camera& camera : {perspective(), rolled(-0.3)}) {
    const Flight flight{.velocity_m_per_s = {1, 2, 3}, .yaw_rad = 0.1, .pitch_rad = -0.05};
    const Camera after = flown(camera, flight, 0.5);
    const glm::vec3 local = glm::transpose(glm::mat3(camera.world_from_camera)) * (eye(after) - eye(camera));
    EXPECT_LT(glm::distance(local, glm::vec3(0.5f, 1.0f, -1.5f)), 2e-6f);
    EXPECT_NEAR(view_angles(after).yaw_rad, view_angles(camera).yaw_rad + 0.1, 1e-6);
    EXPECT_NEAR(view_angles(after).pitch_rad, view_angles(camera).pitch_rad - 0.05, 1e-6);
  }
}

std::vector<glm::vec3> corners_of(glm::vec3 low, glm::vec3 high) {
  std::vector<glm::vec3> out;
  for (int i = 0; i < 8; ++i)
    out.emplace_back((i & 1) != 0 ? high.x : low.x, (i & 2) != 0 ? high.y : low.y, (i & 4) != 0 ? high.z : low.z);
  return out;
}

TEST(CameraControl, FramingShowsTheWholeBoxAndNoMoreThanThat) {
  const double aspect = double(SIZE.x) / double(SIZE.y);
  for (Camera camera : {perspective(), orthographic(), rolled(0.9)}) {
    for (int turn = 0; turn < 12; ++turn) {
      camera = orbited(camera, {}, 0.6, 0.3 * std::sin(turn));
      const glm::vec3 low = LOW + glm::vec3(40, 0, 7), high = HIGH + glm::vec3(41, 9, 8);
      const Camera framed_camera = framed(camera, low, high, aspect);
      EXPECT_EQ(back(framed_camera), back(camera));
      EXPECT_EQ(framed_camera.yfov_rad, camera.yfov_rad);
      glm::vec2 least(1e9f), most(-1e9f);
      for (const glm::vec3& corner : corners_of(low, high)) {
        const glm::vec3 at = seen(framed_camera, corner);
        least = glm::min(least, glm::vec2(at));
        most = glm::max(most, glm::vec2(at));
        EXPECT_GE(at.z, 0.0f);
        EXPECT_LE(at.z, 1.0f);
      }
      EXPECT_GE(std::min(least.x, least.y), 0.0f);
      EXPECT_TRUE(glm::all(glm::lessThanEqual(most, glm::vec2(SIZE))));
      const glm::vec2 share = (most - least) / glm::vec2(SIZE);
      EXPECT_NEAR(std::max(share.x, share.y), 1 / 1.05, 2e-3);
    }
  }
}

TEST(CameraControl, FramingNothingIsACameraAllTheSame) {
  for (const Camera& camera : {perspective(), orthographic()}) {
    const Camera nothing = framed(camera, glm::vec3(5), glm::vec3(5), 1.0);
    EXPECT_GT(glm::distance(eye(nothing), glm::vec3(5)), 0.1f);
    EXPECT_GT(nothing.zfar, nothing.znear);
    EXPECT_GT(nothing.znear, 0.0f);
  }
}

TEST(CameraControl, DepthRangeIsThatOfLookAt) {
  const Camera camera = perspective();
  for (const glm::vec3 place : {glm::vec3(0), glm::vec3(3, 2, 6), glm::vec3(0, 0, 400)}) {
    Camera moved = camera;
    moved.world_from_camera[3] = glm::vec4(place, 1.0f);
    moved = with_depth_of(moved, LOW, HIGH);
    const Camera looking = look_at_camera(place, place + 0.1f * back(camera), camera.yfov_rad, LOW, HIGH);
    EXPECT_EQ(moved.znear, looking.znear);
    EXPECT_EQ(moved.zfar, looking.zfar);
  }
}

TEST(CameraControl, OrthographicDepthRangeHasTheBoxInFront) {
  const Camera flat = orthographic();
  for (const glm::vec3& corner : corners_of(LOW, HIGH)) {
    const float z = seen(flat, corner).z;
    EXPECT_GE(z, 0.0f);
    EXPECT_LE(z, 1.0f);
  }
  Camera away = flat;  // all of it behind
  away.world_from_camera[3] += 100.0f * glm::vec4(-back(flat), 0.0f);
  away = with_depth_of(away, LOW, HIGH);
  EXPECT_GT(away.znear, 0.0f);
  EXPECT_GT(away.zfar, away.znear);
}

TEST(CameraControl, SpeedFollowsTheSizeOfTheScene) {
  EXPECT_FLOAT_EQ(typical_speed_m_per_s(glm::vec3(0), {3, 4, 0}), 0.5f);
  EXPECT_GT(typical_speed_m_per_s(glm::vec3(1), glm::vec3(1)), 0.0f);
}

TEST(CameraControl, LevellingTakesTheRollAlone) {
  const Camera level = levelled(rolled(1.1));
  EXPECT_NEAR(view_angles(level).roll_rad, 0.0, 1e-6);
  EXPECT_LT(glm::distance(back(level), back(perspective())), 1e-6f);
}

}  // namespace
}  // namespace volgi::demo
