// Virtual area lights: the clusters of a plain k-means, where lights are lit, floating as lights move.
#include "screen/visibility/area_maps/virtual_area_lights.h"

#include <cstring>
#include <numeric>
#include <random>

#include "core/error.h"
#include "core/halton.h"
#include "tests/screen/screen_scene.h"
#include "tests/screen/visibility/area_maps/plain_k_means.h"
#include "tests/support/gl_test.h"

namespace volgi::test {
namespace {

using shared::VirtualAreaLight;
using shared::VirtualLight;

constexpr glm::dvec3 kHalf(1.0, 0.75, 1.5);
const double kDiagonal = 2.0 * glm::length(kHalf);
constexpr glm::dvec3 kLamp(0.3, -0.2, 0.7);
constexpr double kFloatsDecide = 2e-7;  // means of 1 m, over the diagonal, and angles of 3e-7 over pi: 5e-8 each

/// The lights of a lamp in a closed box of 2 x 1.5 x 3 m around the origin, in a cone.
std::vector<VirtualLight> lights_in_room(glm::dvec3 axis, double cone_deg, int count) {
  const double height = 1.0 - std::cos(glm::radians(cone_deg));
  const glm::dvec3 side = glm::normalize(glm::cross(axis, glm::dvec3(0.0, 0.0, 1.0)));
  const glm::dmat3 world_from_cone(side, -axis, glm::cross(side, -axis));
  std::vector<VirtualLight> lights;
  for (const glm::vec3 direction : halton_directions_in_cone(height, count)) {
    const glm::dvec3 d = world_from_cone * glm::dvec3(direction);
    const glm::dvec3 steps = (kHalf * glm::sign(d) - kLamp) / d;
    const int wall = steps.x < steps.y ? (steps.x < steps.z ? 0 : 2) : (steps.y < steps.z ? 1 : 2);
    glm::dvec3 normal(0.0);
    normal[wall] = d[wall] > 0.0 ? -1.0 : 1.0;
    const double r = steps[wall];
    const double area = 2.0 * glm::pi<double>() * height / count * r * r / std::max(std::abs(d[wall]), 0.05);
    lights.push_back({kLamp + r * d, float(area), normal, VIRTUAL_LIGHT_REFLECTED, glm::vec3(0.5f, 0.4f, 0.3f), 0});
  }
  return lights;
}

void take_away_flux(std::vector<VirtualLight>& lights, unsigned seed, double share) {
  std::mt19937 random(seed);
  for (VirtualLight& l : lights) {
    if (double(random()) < share * 4294967296.0) l.flux = glm::vec3(0.0f);
  }
}

struct Clusters {
  std::vector<VirtualAreaLight> area_lights;
  std::vector<std::uint32_t> cluster_of, order;
  int alive, iterations;
};

using VirtualAreaLights = GlTest;

Clusters cluster(const gl::Context& context, screen::VirtualAreaLights& pass, const std::vector<VirtualLight>& lights,
                 double diagonal = kDiagonal) {
  gl::PassTimer timer(context.software(), false);
  pass.run(gl::Buffer(lights), int(lights.size()), float(diagonal), timer);
  return {pass.download(), pass.cluster_of().download<std::uint32_t>(lights.size()),
          pass.order().download<std::uint32_t>(lights.size()), pass.alive(), pass.iterations()};
}

Clusters cluster(const gl::Context& context, int count, const std::vector<VirtualLight>& lights,
                 double diagonal = kDiagonal) {
  screen::VirtualAreaLights pass({.count = count});
  return cluster(context, pass, lights, diagonal);
}

/// Every light is in the list of its cluster once, in its own order, and what has no flux is behind all.
void expect_lists(const Clusters& c, const std::vector<VirtualLight>& lights) {
  std::vector<std::uint32_t> sorted(lights.size());
  std::iota(sorted.begin(), sorted.end(), 0u);
  std::stable_sort(sorted.begin(), sorted.end(), [&](auto a, auto b) { return c.cluster_of[a] < c.cluster_of[b]; });
  EXPECT_EQ(c.order, sorted);
  int next = 0, alive = 0;
  for (size_t k = 0; k < c.area_lights.size(); ++k) {
    const int count = int(std::count(c.cluster_of.begin(), c.cluster_of.end(), k));
    EXPECT_EQ(c.area_lights[k].light_count, count);
    if (count > 0) {
      EXPECT_EQ(c.area_lights[k].first_light, next);
    }
    next += count;
    alive += count > 0;
  }
  EXPECT_EQ(alive, c.alive);
  for (size_t i = 0; i < lights.size(); ++i) {
    EXPECT_EQ(c.cluster_of[i] == NO_VIRTUAL_AREA_LIGHT, lights[i].flux == glm::vec3(0.0f));
  }
}

/// What the header says of an area light, from its lights in double.
void expect_sums(const VirtualAreaLight& val, const Clusters& c, const std::vector<VirtualLight>& lights) {
  glm::dvec3 flux(0.0), normal(0.0);
  double area = 0.0;
  glm::dvec2 low(1e30), high(-1e30);
  const glm::dvec3 right(val.right), up = glm::cross(glm::dvec3(val.normal), right);
  for (int j = val.first_light; j < val.first_light + val.light_count; ++j) {
    const VirtualLight& l = lights[c.order[size_t(j)]];
    flux += glm::dvec3(l.flux);
    normal += glm::dvec3(l.normal);
    area += double(l.area_m2);
    const glm::dvec2 st(glm::dot(glm::dvec3(l.position), right), glm::dot(glm::dvec3(l.position), up));
    low = glm::min(low, st);
    high = glm::max(high, st);
  }
  EXPECT_LT(glm::distance(flux, glm::dvec3(val.flux)), 1e-5 * glm::length(flux));
  EXPECT_LT(glm::distance(glm::normalize(normal), glm::dvec3(val.normal)), 1e-5);
  EXPECT_NEAR(glm::length(val.right), 1.0f, 1e-6f);
  EXPECT_NEAR(glm::dot(val.right, val.normal), 0.0f, 1e-6f);
  EXPECT_NEAR(double(val.area_m2), std::max(area, (high.x - low.x) * (high.y - low.y)), 1e-5);
  EXPECT_NEAR(val.size_m, std::sqrt(val.area_m2), 1e-6f);
}

/// That it lies where one of its lights does, and none is nearer to the mean.
void expect_nearest_light(const VirtualAreaLight& val, const Clusters& c, const std::vector<VirtualLight>& lights,
                          glm::dvec3 mean) {
  double smallest = 1e30;
  bool is_one = false;
  for (int j = val.first_light; j < val.first_light + val.light_count; ++j) {
    const glm::vec3 position = lights[c.order[size_t(j)]].position;
    smallest = std::min(smallest, glm::distance(glm::dvec3(position), mean));
    is_one = is_one || position == val.position;
  }
  EXPECT_TRUE(is_one);
  EXPECT_NEAR(glm::distance(glm::dvec3(val.position), mean), smallest, 1e-5);
}

TEST_F(VirtualAreaLights, AreThoseOfAPlainKMeans) {
  struct Case {
    int lights, clusters;
    double without_flux;
  };
  for (const Case& of : {Case{1024, 30, 0.0}, Case{1024, 30, 0.4}, Case{777, 5, 0.1}, Case{1500, 200, 0.0}}) {
    auto lights = lights_in_room(glm::normalize(glm::dvec3(0.2, -1.0, -0.5)), 100.0, of.lights);
    take_away_flux(lights, 7, of.without_flux);
    const Clusters c = cluster(context(), of.clusters, lights);
    const PlainKMeans plain(lights, of.clusters, kDiagonal, screen::VirtualAreaLights::kMaxIterations);
    ASSERT_GT(plain.closest_call(), kFloatsDecide) << "too near a tie for floats: take other lights";
    EXPECT_EQ(c.cluster_of, plain.cluster_of());
    EXPECT_EQ(c.iterations, plain.iterations());
    expect_lists(c, lights);
    for (size_t k = 0; k < c.area_lights.size(); ++k) {
      if (c.area_lights[k].light_count == 0) continue;
      expect_sums(c.area_lights[k], c, lights);
      expect_nearest_light(c.area_lights[k], c, lights, plain.means()[k]);
    }
  }
}

TEST_F(VirtualAreaLights, AtTheMeanAsPrinted) {
  const auto lights = lights_in_room(glm::normalize(glm::dvec3(0.2, -1.0, -0.5)), 100.0, 1024);
  screen::VirtualAreaLights pass({.count = 30, .position = screen::VirtualAreaLightOptions::Position::mean});
  const Clusters c = cluster(context(), pass, lights);
  const PlainKMeans plain(lights, 30, kDiagonal, screen::VirtualAreaLights::kMaxIterations);
  for (size_t k = 0; k < c.area_lights.size(); ++k) {
    if (c.area_lights[k].light_count == 0) continue;
    EXPECT_LT(glm::distance(glm::dvec3(c.area_lights[k].position), plain.means()[k]), 1e-5) << k;
    expect_sums(c.area_lights[k], c, lights);
  }
}

TEST_F(VirtualAreaLights, AsManyAsLightsAreTheLights) {
  const auto lights = lights_in_room({0.0, -1.0, 0.0}, 60.0, 500);
  const Clusters c = cluster(context(), 500, lights);
  for (size_t i = 0; i < lights.size(); ++i) {
    EXPECT_EQ(c.cluster_of[i], i);
    EXPECT_EQ(c.area_lights[i].position, lights[i].position);
    EXPECT_EQ(c.area_lights[i].normal, lights[i].normal);
    EXPECT_EQ(c.area_lights[i].area_m2, lights[i].area_m2);
    EXPECT_EQ(c.area_lights[i].flux, lights[i].flux);
  }
}

TEST_F(VirtualAreaLights, OneHoldsAllLights) {
  auto lights = lights_in_room({0.0, -1.0, 0.0}, 30.0, 300);
  take_away_flux(lights, 3, 0.2);
  const Clusters c = cluster(context(), 1, lights);
  expect_lists(c, lights);
  expect_sums(c.area_lights[0], c, lights);
}

TEST_F(VirtualAreaLights, MoreThanLightsWithFlux) {
  for (const int clusters : {41, 200, 1024}) {
    auto lights = lights_in_room({0.0, -1.0, 0.0}, 60.0, 120);
    for (size_t i = 0; i < lights.size(); ++i) {
      if (i % 3 != 1) lights[i].flux = glm::vec3(0.0f);
    }
    const Clusters c = cluster(context(), clusters, lights);
    expect_lists(c, lights);
    EXPECT_EQ(c.alive, 40);
  }
  for (const int count : {0, 70}) {
    std::vector<VirtualLight> dark = lights_in_room({0.0, -1.0, 0.0}, 60.0, count);
    for (VirtualLight& l : dark) l.flux = glm::vec3(0.0f);
    const Clusters c = cluster(context(), 30, dark);
    expect_lists(c, dark);
    EXPECT_EQ(c.alive, 0);
  }
}

// A whole stretch of the list without flux: its seeds go on to the next lights, and none is left out.
TEST_F(VirtualAreaLights, SeedsQueueUpAndGoRound) {
  auto lights = lights_in_room({0.0, -1.0, 0.0}, 100.0, 1000);
  for (size_t i = 550; i < lights.size(); ++i) lights[i].flux = glm::vec3(0.0f);
  const Clusters c = cluster(context(), 300, lights);
  const PlainKMeans plain(lights, 300, kDiagonal, screen::VirtualAreaLights::kMaxIterations);
  ASSERT_GT(plain.closest_call(), kFloatsDecide);
  EXPECT_EQ(c.cluster_of, plain.cluster_of());
  EXPECT_GE(c.alive, 290);
}

TEST_F(VirtualAreaLights, InACornerDoNotMixWalls) {
  const auto lights = lights_in_room(glm::normalize(glm::dvec3(1.0, -1.0, 1.0)), 50.0, 1024);
  const Clusters c = cluster(context(), 30, lights);
  for (const VirtualAreaLight& val : c.area_lights) {
    for (int j = val.first_light; j < val.first_light + val.light_count; ++j) {
      EXPECT_EQ(glm::vec3(lights[c.order[size_t(j)]].normal), val.normal);
    }
  }
}

VirtualLight light_at(glm::vec3 position, glm::vec3 normal, float area_m2) {
  return {position, area_m2, normal, VIRTUAL_LIGHT_REFLECTED, glm::vec3(1.0f), 0};
}

TEST_F(VirtualAreaLights, BoundTheirLights) {
  for (const glm::vec3 normal : {glm::vec3(0, 1, 0), glm::vec3(0, 0, -1), glm::vec3(1, 0, 0)}) {
    const glm::vec3 u(normal.y, normal.z, normal.x);  // 6 steps of 0.2 m along u, 3 of 0.3 m across
    const glm::vec3 v = glm::cross(normal, u);
    for (const float area : {0.001f, 0.06f}) {
      std::vector<VirtualLight> lights;
      for (int i = 0; i < 28; ++i) {
        const int column = i % 7, row = i / 7;
        lights.push_back(light_at(0.2f * float(column) * u + 0.3f * float(row) * v, normal, area));
      }
      const VirtualAreaLight val = cluster(context(), 1, lights).area_lights[0];
      EXPECT_NEAR(val.area_m2, area < 0.01f ? 1.2f * 0.9f : 28.0f * area, 1e-5f);
    }
  }
}

TEST_F(VirtualAreaLights, GiveTiesToTheFirst) {
  for (const float side : {1.0f, -1.0f}) {
    const Clusters c = cluster(context(), 2,
                               {light_at({side, 0, 0}, {0, 1, 0}, 0.1f), light_at({-side, 0, 0}, {0, 1, 0}, 0.1f),
                                light_at({0, 0, 0}, {0, 1, 0}, 0.1f)});
    EXPECT_EQ(c.cluster_of, (std::vector<std::uint32_t>{0, 1, 0}));
  }
}

TEST_F(VirtualAreaLights, RepeatToTheByte) {
  auto lights = lights_in_room(glm::normalize(glm::dvec3(0.2, -1.0, -0.5)), 120.0, 3000);
  take_away_flux(lights, 5, 0.3);
  screen::VirtualAreaLights pass({.count = 100});
  const Clusters first = cluster(context(), pass, lights);
  cluster(context(), pass, lights_in_room({0.0, 1.0, 0.0}, 40.0, 4000));
  const Clusters again = cluster(context(), pass, lights);
  const Clusters other = cluster(context(), 100, lights);
  EXPECT_EQ(first.cluster_of, again.cluster_of);
  EXPECT_EQ(first.order, other.order);
  const size_t bytes = first.area_lights.size() * sizeof(VirtualAreaLight);
  EXPECT_EQ(std::memcmp(first.area_lights.data(), again.area_lights.data(), bytes), 0);
}

// Where lights stand on a sphere, around an edge, on two steps, or around a pillar, the mean is inside.
TEST_F(VirtualAreaLights, LieOutsideOfWhatTheirLightsLieOn) {
  std::vector<VirtualLight> sphere, edge, steps, floor;
  for (const glm::vec3 d : halton_directions_in_cone(1.0, 400)) sphere.push_back(light_at(d, d, 0.015f));
  for (int i = 1; i <= 300; ++i) {
    const glm::vec2 at(halton(std::uint64_t(i)));
    const bool top = i % 4 != 0;
    edge.push_back(top ? light_at({-at.x, 0, at.y}, {0, 1, 0}, 0.004f) : light_at({0, -at.x, at.y}, {1, 0, 0}, 0.012f));
    steps.push_back(light_at({2.0f * at.x - 1.0f, at.x < 0.45f ? 0.0f : 0.4f, at.y}, {0, 1, 0}, 0.006f));
    const glm::vec2 p = 2.0f * at - 1.0f;
    if (glm::max(std::abs(p.x), std::abs(p.y)) > 0.4f) floor.push_back(light_at({p.x, 0, p.y}, {0, 1, 0}, 0.013f));
  }
  for (const int count : {1, 2, 6}) {
    for (const VirtualAreaLight& val : cluster(context(), count, sphere, 3.5).area_lights) {
      EXPECT_GE(glm::length(val.position), 0.999f);
      EXPECT_LE(glm::length(val.position), 1.1f);
    }
    for (const VirtualAreaLight& val : cluster(context(), count, edge, 3.5).area_lights) {
      EXPECT_GE(std::max(val.position.x, val.position.y), -1e-5f);
      EXPECT_LE(std::max(val.position.x, val.position.y), 0.3f);
    }
  }
  const VirtualAreaLight on_steps = cluster(context(), 1, steps, 3.5).area_lights[0];
  EXPECT_GE(on_steps.position.y, on_steps.position.x < -0.1f ? -1e-5f : 0.39999f);
  const VirtualAreaLight around = cluster(context(), 1, floor, 3.5).area_lights[0];
  EXPECT_GT(std::max(std::abs(around.position.x), std::abs(around.position.z)), 0.2f);  // 0.13 = 2 radii from a light
  EXPECT_NEAR(around.position.y, 0.0f, 1e-6f);
}

/// How far area lights and lights move from frame to frame.
class Drift {
 public:
  void add(const std::vector<VirtualAreaLight>& area_lights, const std::vector<VirtualLight>& lights) {
    for (size_t k = 0; k < before_.size(); ++k) {
      if (before_[k].light_count == 0 || area_lights[k].light_count == 0) continue;
      double smallest = 1e30;
      for (const VirtualAreaLight& b : before_) {
        if (b.light_count > 0)
          smallest = std::min(smallest, double(glm::distance(b.position, area_lights[k].position)));
      }
      nearest_ += smallest;
      same_ += double(glm::distance(before_[k].position, area_lights[k].position));
      ++area_light_moves_;
    }
    for (size_t i = 0; i < lights_before_.size(); ++i) {
      if (lights[i].flux == glm::vec3(0.0f) || lights_before_[i].flux == glm::vec3(0.0f)) continue;
      lights_ += double(glm::distance(lights_before_[i].position, lights[i].position));
      ++light_moves_;
    }
    before_ = area_lights;
    lights_before_ = lights;
  }
  /// Mean moves over that of lights: of an area light, and from the nearest one of the frame before.
  double ratio() const { return same_ / area_light_moves_ / (lights_ / light_moves_); }
  double ratio_to_nearest() const { return nearest_ / area_light_moves_ / (lights_ / light_moves_); }

 private:
  std::vector<VirtualAreaLight> before_;
  std::vector<VirtualLight> lights_before_;
  double same_ = 0.0, nearest_ = 0.0, lights_ = 0.0;
  int area_light_moves_ = 0, light_moves_ = 0;
};

// Dong et al. 2009, Fig. 8: a spot light turns from a wall to the ceiling; and where the wall has a window, lights come
// and go, up to half of them in all.
TEST_F(VirtualAreaLights, FloatAndLiveAsTheLightTurns) {
  for (const bool window : {false, true}) {
    constexpr int frames = 200;
    screen::VirtualAreaLights pass({.count = 30});
    Drift drift;
    int min_alive = 30;
    for (int frame = 0; frame < frames; ++frame) {
      const double tilt = glm::radians(80.0 * frame / (frames - 1));
      auto lights = lights_in_room({std::cos(tilt), std::sin(tilt), 0.0}, 30.0, 1024);
      for (VirtualLight& l : lights) {
        const bool inside = std::abs(l.position.y) < 0.4f && std::abs(l.position.z - 0.6f) < 0.4f;
        if (window && l.normal.x < 0.0f && inside) l.flux = glm::vec3(0.0f);
      }
      const Clusters c = cluster(context(), pass, lights);
      min_alive = std::min(min_alive, c.alive);
      drift.add(c.area_lights, lights);
    }
    EXPECT_GE(min_alive, 27);
    // Measured: 2.2 and 2.0; with the window 3.5 and 2.2: area lights step from light to light. Seeds from light k L /
    // M of the L with flux would make that ten times and more than twice as much.
    EXPECT_LT(drift.ratio(), window ? 3.7 : 2.5);
    EXPECT_LT(drift.ratio_to_nearest(), window ? 2.3 : 2.2);
    RecordProperty("min_alive", min_alive);
    RecordProperty("ratio", std::to_string(drift.ratio()));
  }
}

// In a scene's own lights: a spot crosses a floor, a box, a sphere and a plate that hangs in the air.
TEST_F(VirtualAreaLights, StayOutsideOfASceneAsTheLightCrossesIt) {
  Scene scene = stage();
  const glm::vec3 middle(-1.0f, 0.5f, 0.9f);
  add_sphere(scene, 1, middle, 0.4f, 24);
  update_bounds(scene);
  scene.lights = {spot_light({}, {0, -1, 0}, 20, 30, 5.0f)};
  gl::PassTimer timer(context().software(), false);
  const gl::SceneBuffers buffers(scene);
  screen::ReflectiveShadowMap maps({200, 100, 200});
  screen::VirtualLights lights(scene, {1024, {}, screen::VirtualLightOptions::Sampling::halton});
  screen::VirtualAreaLights pass({.count = 30});
  Drift drift;
  int min_alive = 30, inside_sphere = 0, inside_box = 0;
  for (int frame = 0; frame < 60; ++frame) {
    const float s = float(frame) / 59.0f;
    scene.lights[0].position = {-1.6f + 3.0f * s, 2.6f, 1.4f};
    scene.lights[0].direction = glm::normalize(glm::vec3(0.1f, -1.0f, -0.5f));
    maps.run(buffers, scene, timer);
    lights.run(maps, nullptr, timer);
    pass.run(lights, glm::distance(scene.bounds_min, scene.bounds_max), timer);
    const auto area_lights = pass.download();
    drift.add(area_lights, lights.download().lights);
    min_alive = std::min(min_alive, pass.alive());
    for (const VirtualAreaLight& l : area_lights) {
      if (l.light_count == 0) continue;
      inside_sphere += glm::distance(l.position, middle) < 0.4f * 0.991f;  // facets: cos(pi / 24)
      const glm::vec3 d = l.position - glm::vec3(0.3f, 0.4f, 0.2f);        // the box of stage()
      const glm::vec2 across(std::cos(0.5f) * d.x - std::sin(0.5f) * d.z, std::sin(0.5f) * d.x + std::cos(0.5f) * d.z);
      inside_box += std::abs(across.x) < 0.449f && std::abs(across.y) < 0.349f && std::abs(d.y) < 0.399f;
    }
  }
  EXPECT_GE(min_alive, 27);
  EXPECT_EQ(inside_sphere, 0);
  EXPECT_EQ(inside_box, 0);
  EXPECT_LT(drift.ratio_to_nearest(), 1.5);  // measured: 1.2
}

TEST_F(VirtualAreaLights, RefuseWhatMakesNoSense) {
  using screen::VirtualAreaLightOptions;
  for (const VirtualAreaLightOptions& options :
       {VirtualAreaLightOptions{.count = 0}, VirtualAreaLightOptions{.count = MAX_VIRTUAL_AREA_LIGHTS + 1},
        VirtualAreaLightOptions{.normal_weight = -0.1f}, VirtualAreaLightOptions{.position_weight = INFINITY}}) {
    EXPECT_THROW(screen::VirtualAreaLights pass(options), Error);
  }
}

}  // namespace
}  // namespace volgi::test
