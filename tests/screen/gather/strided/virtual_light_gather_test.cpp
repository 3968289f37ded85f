// The gather of virtual lights against closed forms and double precision, and the discontinuity buffer against the
// gather at every pixel.
#include <random>

#include "tests/screen/gathered.h"
#include "tests/support/gl_test.h"

namespace volgi::test {
namespace {

using VirtualLightGatherTest = GlTest;

Scene floor_scene(glm::vec3 albedo) {
  Scene scene;
  add_quad(scene, add_material(scene, albedo), {-2, 0, -2}, {0, 0, 4}, {4, 0, 0});
  update_bounds(scene);
  return scene;
}

Camera above(const Scene& scene, float height = 3.0f) {
  return look_at_camera({0.0f, height, 0.01f}, {0, 0, 0}, 0.9f, scene.bounds_min, scene.bounds_max);
}

/// Lights anywhere around the stage, facing anywhere.
std::vector<VirtualLight> random_lights(int count, int kind, unsigned seed) {
  std::mt19937 random(seed);
  const auto uniform = [&] { return float(random()) / 4294967296.0f; };
  std::vector<VirtualLight> lights;
  for (int i = 0; i < count; ++i) {
    const glm::vec3 position(4.0f * uniform() - 2.0f, 3.0f * uniform(), 4.0f * uniform() - 2.0f);
    const glm::vec3 normal(uniform() - 0.5f, uniform() - 0.5f, uniform() - 0.5f);
    lights.push_back(light_at(position, normal, {uniform(), uniform(), uniform()}, 0.05f, kind));
  }
  return lights;
}

Scene stage_with_sphere() {
  Scene scene = stage();
  add_sphere(scene, 1, {-1.0f, 0.5f, 0.9f}, 0.4f, 24);
  return scene;
}

TEST_F(VirtualLightGatherTest, OneDiskOverAPlaneIsTheFormula) {
  const glm::vec3 albedo(0.8f, 0.5f, 0.2f);
  const Scene scene = floor_scene(albedo);
  const Camera camera = above(scene);
  Seen seen(context(), scene, camera, {40, 30});
  const VirtualLight light = light_at({0.3f, 0.7f, -0.2f}, {0.5f, -0.8f, 0.1f}, {3, 2, 1}, 0.3f);
  const Gathered picture = gathered(seen, list_of({light}), every_pixel());
  int lit = 0;
  for (int y = 0; y < 30; ++y) {
    for (int x = 0; x < 40; ++x) {
      const CameraRay ray = camera_ray(camera, glm::vec2(x, 29 - y) + 0.5f, seen.size);
      const glm::dvec3 at =
          glm::dvec3(ray.origin) - glm::dvec3(ray.direction) * (double(ray.origin.y) / double(ray.direction.y));
      const double form = disk_to_point_exact(at, {0, 1, 0}, light.position, light.normal, 0.3);
      for (int c = 0; c < 3; ++c) {
        const double expected = double(albedo[c]) / glm::pi<double>() * double(light.flux[c]) * form;
        EXPECT_NEAR(double(picture.indirect[size_t(y * 40 + x)][c]), expected, 2e-4 * expected + 1e-6);
        lit += expected > 1e-3;
      }
    }
  }
  EXPECT_GT(lit, 1000);
  for (const glm::vec4& p : picture.direct) EXPECT_EQ(glm::vec3(p), glm::vec3(0.0f));
}

// Reflected lights end and emitted ones begin inside a block; each has its own picture, and the background is black.
TEST_F(VirtualLightGatherTest, ThreeBlocksAreTheSumOfTheirLights) {
  const Scene scene = stage_with_sphere();
  Seen seen(context(), scene, stage_camera(scene), {48, 36});
  const auto reflected = random_lights(1500, VIRTUAL_LIGHT_REFLECTED, 1);
  const auto emitted = random_lights(1000, VIRTUAL_LIGHT_EMITTED, 2);
  const VirtualLightListGl lights = list_of(reflected, emitted);
  ASSERT_EQ(lights.buffer.bytes(), 3 * VIRTUAL_LIGHTS_PER_BLOCK * sizeof(VirtualLight));
  const Gathered picture = gathered(seen, lights, every_pixel());
  const Gathered emitted_only = gathered(seen, lights, every_pixel(), nullptr, VirtualLightGather::Part::emitted);
  int background = 0;
  double worst = 0.0;
  for (size_t i = 0; i < seen.position.size(); ++i) {
    const glm::dvec3 indirect = radiance_of(reflected, seen, i), direct = radiance_of(emitted, seen, i);
    background += seen.position[i].w == 0.0f;
    EXPECT_EQ(picture.direct[i], emitted_only.direct[i]);
    EXPECT_EQ(glm::vec3(emitted_only.indirect[i]), glm::vec3(0.0f));
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(double(picture.indirect[i][c]), indirect[c], 1e-5 * indirect[c]) << i;
      EXPECT_NEAR(double(picture.direct[i][c]), direct[c], 1e-5 * direct[c]) << i;
      if (indirect[c] > 0.0) worst = std::max(worst, std::abs(double(picture.indirect[i][c]) / indirect[c] - 1.0));
    }
  }
  EXPECT_GT(background, 50);
  RecordProperty("worst", std::to_string(worst));
}

TEST_F(VirtualLightGatherTest, LightsBehindAHorizonGiveNothing) {
  Scene scene = floor_scene(glm::vec3(0.7f));
  for (glm::vec3& n : scene.meshes[0].normals) n = glm::normalize(glm::vec3(1.0f, 1.0f, 0.0f));
  Seen seen(context(), scene, above(scene), {8, 8});
  const auto light_of = [&](const VirtualLight& light) {
    double sum = 0.0;
    for (const glm::vec4& p : gathered(seen, list_of({light}), every_pixel()).indirect) sum += double(p.x);
    return sum;
  };
  EXPECT_GT(light_of(light_at({9, 3, 0}, {-1, -0.3f, 0})), 0.0);
  EXPECT_EQ(light_of(light_at({9, -3, 0}, {-1, 0.3f, 0})), 0.0);  // below the surface, above the shading horizon
  EXPECT_EQ(light_of(light_at({-9, 3, 0}, {1, -0.3f, 0})), 0.0);  // the other way round
  EXPECT_EQ(light_of(light_at({9, 3, 0}, {1, 0.3f, 0})), 0.0);    // faces away
}

TEST_F(VirtualLightGatherTest, NoLightsAreBlack) {
  const Scene scene = stage();
  Seen seen(context(), scene, stage_camera(scene), {31, 17});
  for (const int stride : {1, 2}) {
    GatherOptions o;
    o.stride = stride;
    const Gathered picture = gathered(seen, list_of({}), o);
    for (size_t i = 0; i < picture.indirect.size(); ++i)
      EXPECT_EQ(glm::vec3(picture.indirect[i] + picture.direct[i]), glm::vec3(0.0f));
  }
}

// Where every pixel differs from its neighbours, all are gathered, whatever the size.
TEST_F(VirtualLightGatherTest, AllPixelsDifferentAreThePictureOfEveryPixel) {
  const Scene scene = stage_with_sphere();
  const VirtualLightListGl lights = list_of(random_lights(30, VIRTUAL_LIGHT_REFLECTED, 3),  //
                                            random_lights(20, VIRTUAL_LIGHT_EMITTED, 4));
  for (const glm::ivec2 size : {glm::ivec2(97, 61), {64, 48}, {1, 1}, {1, 64}, {63, 1}, {2, 3}, {5, 4}}) {
    Seen seen(context(), scene, stage_camera(scene), size);
    const Gathered every = gathered(seen, lights, every_pixel());
    EXPECT_EQ(every.coarse_share, 0.0f);
    for (const int stride : {2, 4, 16}) {
      GatherOptions o;
      o.stride = stride;
      o.distance = 0.0f;
      const Gathered picture = gathered(seen, lights, o);
      int listed = 0, differ = 0;
      for (int i = 0; i < size.x * size.y; ++i) {
        const glm::ivec2 at(i % size.x, i / size.x);
        const bool coarse = (at.x % stride == 0 || at.x == size.x - 1) && (at.y % stride == 0 || at.y == size.y - 1);
        listed += !coarse && seen.position[size_t(i)].w != 0.0f;
        differ += glm::vec3(picture.indirect[size_t(i)]) != glm::vec3(every.indirect[size_t(i)]);
        differ += glm::vec3(picture.direct[size_t(i)]) != glm::vec3(every.direct[size_t(i)]);
      }
      EXPECT_EQ(differ, 0) << size.x << 'x' << size.y << ' ' << stride;
      EXPECT_NEAR(picture.coarse_share, 1.0 - double(listed) / double(size.x * size.y), 1e-6);
    }
  }
}

// Contrast 0 lists all but equal ones; threshold 0 all on curved surfaces.
TEST_F(VirtualLightGatherTest, EachCriterionAloneListsPixels) {
  const Scene scene = stage_with_sphere();
  Seen seen(context(), scene, stage_camera(scene), {97, 61});
  const VirtualLightListGl lights = list_of(random_lights(30, VIRTUAL_LIGHT_REFLECTED, 3));
  const Gathered every = gathered(seen, lights, every_pixel());
  for (const int stride : {2, 4}) {
    const GatherOptions by_contrast{stride, 10.0f, 0.0f, 10.0f}, by_angle{stride, 0.0f, 10.0f, 10.0f};
    const Gathered contrast = gathered(seen, lights, by_contrast), angle = gathered(seen, lights, by_angle);
    int on_sphere = 0;
    for (size_t i = 0; i < seen.position.size(); ++i) {
      const glm::vec3 tolerance = 1e-6f * glm::abs(glm::vec3(every.indirect[i]));
      const glm::vec3 error = glm::abs(glm::vec3(contrast.indirect[i] - every.indirect[i]));
      EXPECT_TRUE(glm::all(glm::lessThanEqual(error, tolerance))) << i;
      const bool curved = glm::distance(glm::vec3(seen.position[i]), glm::vec3(-1.0f, 0.5f, 0.9f)) < 0.41f;
      if (seen.position[i].w == 0.0f || !curved) continue;
      ++on_sphere;
      EXPECT_EQ(angle.indirect[i], every.indirect[i]) << i;
    }
    EXPECT_GT(on_sphere, 100);
    EXPECT_GT(angle.coarse_share, 0.3f);
  }
}

TEST_F(VirtualLightGatherTest, OnAPlaneAlmostNothingIsGatheredAgain) {
  const Scene scene = floor_scene(glm::vec3(0.7f));
  Seen seen(context(), scene, above(scene), {160, 120});
  const VirtualLightListGl lights = list_of({light_at({0.3f, 1.0f, -0.2f}, {0, -1, 0})});
  const Gathered every = gathered(seen, lights, every_pixel());
  const Gathered picture = gathered(seen, lights, {});
  double worst = 0.0, largest = 0.0;
  for (size_t i = 0; i < seen.position.size(); ++i) {
    worst = std::max(worst, std::abs(double(picture.indirect[i].x) - double(every.indirect[i].x)));
    largest = std::max(largest, double(every.indirect[i].x));
  }
  EXPECT_GT(picture.coarse_share, 0.99f);
  // Interpolation errs by s^2 / 8 of f'' on each axis: at 1 m, where f = (1 + r^2)^-2, f'' is at most 4 of the largest.
  const double coarse_m = 2.0 * 3.0 * 2.0 * std::tan(0.45) / 120.0;
  EXPECT_LT(worst / largest, 2.0 * 4.0 * coarse_m * coarse_m / 8.0);
  RecordProperty("share", std::to_string(picture.coarse_share));
  RecordProperty("worst", std::to_string(worst / largest));
}

// Two planes one above the other, seen from above: only the distance off the plane tells them apart.
TEST_F(VirtualLightGatherTest, DepthEdgesBetweenParallelPlanesAreListed) {
  Scene scene = floor_scene(glm::vec3(0.7f));
  add_quad(scene, 0, {-0.31f, 0.3f, -0.47f}, {0, 0, 1}, {0.8f, 0, 0});
  update_bounds(scene);
  Seen seen(context(), scene, above(scene), {97, 61});
  const VirtualLightListGl lights = list_of({light_at({0.1f, 0.9f, 0.1f}, {0, -1, 0})});
  const Gathered every = gathered(seen, lights, every_pixel());
  const Gathered picture = gathered(seen, lights, {2, 0.2f, 10.0f, 10.0f});
  const auto on_floor = [&](int x, int y) { return seen.position[size_t(y) * 97 + size_t(x)].y < 0.1f; };
  int edges = 0;
  for (int y = 0; y < 61; ++y) {
    for (int x = 0; x < 97; ++x) {
      // The coarse pixels that it lies between.
      bool differs = false;
      for (const int v : {y - y % 2, y + y % 2}) {
        for (const int u : {x - x % 2, x + x % 2}) differs = differs || on_floor(u, v) != on_floor(x, y);
      }
      if (!differs) continue;
      ++edges;
      EXPECT_EQ(picture.indirect[size_t(y) * 97 + size_t(x)], every.indirect[size_t(y * 97 + x)]) << x << ' ' << y;
    }
  }
  EXPECT_GT(edges, 50);
  EXPECT_NEAR(picture.coarse_share, 1.0 - edges / (97.0 * 61.0), 1e-6);
}

// More pixels than one row of groups holds, on the grid and in the list.
TEST_F(VirtualLightGatherTest, ListsLongerThanARowOfGroups) {
  const Scene scene = floor_scene(glm::vec3(0.7f));
  const glm::ivec2 size(2000, 1500);
  Seen seen(context(), scene, above(scene, 1.0f), size);
  const VirtualLightListGl lights = list_of({light_at({0.3f, 1.0f, -0.2f}, {0, -1, 0})});
  const Gathered every = gathered(seen, lights, every_pixel());
  const Gathered picture = gathered(seen, lights, {2, 0.2f, 1.0f, 0.0f});
  EXPECT_GT((1.0 - double(picture.coarse_share)) * size.x * size.y, 64.0 * 32768.0);
  EXPECT_TRUE(picture.indirect == every.indirect);
  int lit = 0;
  for (const glm::vec4& p : every.indirect) lit += p.x > 0.0f;
  EXPECT_EQ(lit, size.x * size.y);
}

TEST_F(VirtualLightGatherTest, LightsAtThePixelItselfAreHarmless) {
  const Scene scene = floor_scene(glm::vec3(0.7f));
  Seen seen(context(), scene, above(scene), {8, 8});
  const glm::vec3 there(seen.position[27]);
  const VirtualLight without_area = light_at(there, {0, 1, 0}, glm::vec3(0.0f), 0.0f);
  const VirtualLight strong = light_at(there + glm::vec3(0, 1e-6f, 0), {0, -1, 0}, glm::vec3(1e6f), 0.01f);
  for (const VirtualLight& light : {without_area, light_at(there, {0, 1, 0}, glm::vec3(1.0f), 0.0f),
                                    light_at(there, {0, -1, 0}, glm::vec3(1.0f), 0.0f), strong}) {
    for (const glm::vec4& p : gathered(seen, list_of({light}), every_pixel()).indirect)
      EXPECT_TRUE(std::isfinite(p.x) && p.x >= 0.0f);
  }
}

/// Blocks without a buffer are undefined to read, even where the program reads none of their lights.
TEST_F(VirtualLightGatherTest, DeclaresNoBlockThatIsNotBound) {
  const Scene scene = floor_scene(glm::vec3(0.5f));
  Seen seen(context(), scene, above(scene), glm::ivec2(8));
  for (GLuint binding = 0; binding < 4; ++binding) glBindBufferBase(GL_UNIFORM_BUFFER, binding, 0);
  const VirtualLightListGl lights = list_of({light_at({0, 1, 0}, {0, -1, 0})});
  gathered(seen, lights, every_pixel());
  GLint program = 0, blocks = 0;
  glGetIntegerv(GL_CURRENT_PROGRAM, &program);
  glGetProgramiv(GLuint(program), GL_ACTIVE_UNIFORM_BLOCKS, &blocks);
  ASSERT_GT(blocks, 0);
  for (GLint block = 0; block < blocks; ++block) {
    GLint binding = 0, buffer = 0;
    glGetActiveUniformBlockiv(GLuint(program), GLuint(block), GL_UNIFORM_BLOCK_BINDING, &binding);
    glGetIntegeri_v(GL_UNIFORM_BUFFER_BINDING, GLuint(binding), &buffer);
    EXPECT_NE(buffer, 0) << "block " << block << " at binding " << binding;
  }
}

}  // namespace
}  // namespace volgi::test
