#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "core/camera.h"

namespace volgi {
namespace {

constexpr glm::ivec2 size(320, 200);

Camera turned_camera(Camera::Kind kind) {
  Camera camera;
  camera.kind = kind;
  camera.yfov_rad = 0.9f;
  camera.ymag = 2.5f;
  camera.znear = 0.5f;
  camera.zfar = 40.0f;
  camera.world_from_camera = glm::translate(glm::mat4(1.0f), {1, 2, 3}) *
                             glm::rotate(glm::mat4(1.0f), 0.8f, glm::normalize(glm::vec3(1, 2, -0.5f)));
  return camera;
}

/// Picture position and depth of a world point by the clip matrix.
glm::vec3 project(const Camera& camera, glm::vec3 world) {
  const glm::vec4 clip = clip_from_camera(camera, size) * camera_from_world(camera) * glm::vec4(world, 1.0f);
  const glm::vec3 ndc = glm::vec3(clip) / clip.w;
  return {(0.5f + 0.5f * ndc.x) * float(size.x), (0.5f - 0.5f * ndc.y) * float(size.y), ndc.z};
}

class BothKinds : public ::testing::TestWithParam<Camera::Kind> {};
INSTANTIATE_TEST_SUITE_P(Camera, BothKinds, ::testing::Values(Camera::Kind::perspective, Camera::Kind::orthographic));

TEST_P(BothKinds, ClipMatrixProjectsARayOntoItsPixel) {
  const Camera camera = turned_camera(GetParam());
  for (const glm::vec2 pixel :
       {glm::vec2(0.5f, 0.5f), glm::vec2(160, 100), glm::vec2(17.25f, 180.5f), glm::vec2(320, 200)}) {
    const CameraRay ray = camera_ray(camera, pixel, size);
    EXPECT_NEAR(glm::length(ray.direction), 1.0f, 1e-6f);
    for (const float distance : {1.0f, 10.0f, 39.0f}) {
      const glm::vec3 at = project(camera, ray.origin + distance * ray.direction);
      EXPECT_NEAR(at.x, pixel.x, 2e-3f);
      EXPECT_NEAR(at.y, pixel.y, 2e-3f);
    }
  }
}

TEST_P(BothKinds, DepthIsOneAtTheNearPlaneAndZeroAtTheFarOne) {
  const Camera camera = turned_camera(GetParam());
  const auto depth = [&](float z) {
    return project(camera, glm::vec3(camera.world_from_camera * glm::vec4(0, 0, -z, 1))).z;
  };
  EXPECT_NEAR(depth(0.5f), 1.0f, 1e-5f);
  EXPECT_NEAR(depth(40.0f), 0.0f, 1e-5f);
  EXPECT_GT(depth(5.0f), depth(6.0f));
}

TEST(Camera, FieldOfViewIsVerticalAndTheTopLeftIsTheOrigin) {
  Camera camera;
  camera.yfov_rad = 1.0f;
  const CameraRay top = camera_ray(camera, {160, 0}, size);
  EXPECT_NEAR(top.direction.y / -top.direction.z, std::tan(0.5f), 1e-6f);
  const CameraRay left = camera_ray(camera, {0, 100}, size);
  EXPECT_NEAR(left.direction.x / left.direction.z, std::tan(0.5f) * 1.6f, 1e-6f);
}

TEST(Camera, OrthographicRaysAreParallel) {
  const Camera camera = turned_camera(Camera::Kind::orthographic);
  const CameraRay a = camera_ray(camera, {0, 0}, size);
  const CameraRay b = camera_ray(camera, {320, 200}, size);
  EXPECT_LT(glm::distance(a.direction, b.direction), 1e-6f);
  EXPECT_NEAR(glm::distance(a.origin, b.origin), 2.0f * 2.5f * std::sqrt(1.6f * 1.6f + 1.0f), 1e-4f);
}

TEST(Camera, LookAtSeesItsTargetInTheMiddle) {
  for (const glm::vec3 eye : {glm::vec3(3, 4, 5), glm::vec3(0, 9, 0), glm::vec3(0, -9, 0), glm::vec3(0, 0, 3)}) {
    const Camera camera = look_at_camera(eye, {0.1f, 0, 0}, 0.7f, glm::vec3(-1), glm::vec3(1));
    const glm::vec3 at = project(camera, {0.1f, 0, 0});
    EXPECT_NEAR(at.x, 160.0f, 1e-2f);
    EXPECT_NEAR(at.y, 100.0f, 1e-2f);
    EXPECT_NEAR(glm::determinant(glm::mat3(camera.world_from_camera)), 1.0f, 1e-5f);
  }
}

TEST(Camera, NearAndFarPlanesHoldTheBounds) {
  for (const float scale : {1e-3f, 1.0f, 1e3f}) {
    const Camera outside =
        look_at_camera(scale * glm::vec3(10, 0, 0), {0, 0, 0}, 0.7f, glm::vec3(-scale), glm::vec3(scale));
    EXPECT_LE(outside.znear, 9.0f * scale);
    EXPECT_GE(outside.zfar, 11.0f * scale);
    const Camera inside =
        look_at_camera(glm::vec3(0), scale * glm::vec3(1, 0, 0), 0.7f, glm::vec3(-scale), glm::vec3(scale));
    EXPECT_GT(inside.znear, 0.0f);
    EXPECT_LE(inside.znear, 1e-3f * scale);
  }
}

TEST(Camera, FramingSeesEveryCornerOfTheBox) {
  const glm::vec3 low(-3, -1, -20), high(5, 8, 2);
  const Camera camera = framing_camera(low, high);
  for (int corner = 0; corner < 8; ++corner) {
    const glm::vec3 p((corner & 1 ? high : low).x, (corner & 2 ? high : low).y, (corner & 4 ? high : low).z);
    const glm::vec3 at = project(camera, p);
    EXPECT_GT(at.x, 0.0f);
    EXPECT_LT(at.x, 320.0f);
    EXPECT_GT(at.y, 0.0f);
    EXPECT_LT(at.y, 200.0f);
    EXPECT_GT(at.z, 0.0f);
    EXPECT_LT(at.z, 1.0f);
  }
}

TEST(Camera, FramingNothingIsStillACamera) {
  const Camera camera = framing_camera(glm::vec3(0), glm::vec3(0));
  EXPECT_TRUE(std::isfinite(camera.world_from_camera[3].z));
  EXPECT_GT(camera.zfar, camera.znear);
  EXPECT_GT(camera.znear, 0.0f);
}

}  // namespace
}  // namespace volgi
