// Negative lights: how much of the light they take away that bodies should have stopped, and that they take none where
// nothing stops any.
#include "core/halton.h"
#include "core/visibility/embree_scene.h"
#include "shaders/screen/base/slots.shared.h"
#include "shaders/screen/visibility/negative/slots.shared.h"
#include "shaders/shared/group_sizes.shared.h"
#include "tests/screen/gathered.h"
#include "tests/screen/virtual_light_scenes.h"
#include "tests/support/gl_test.h"
#include "tests/support/voxels.h"
#include "voxel/voxelize_cpu.h"

namespace volgi::test {
namespace {

using NegativeLightsTest = GlTest;
using screen::NegativeLightOptions;
using screen::NegativeLights;
using Method = NegativeLightOptions::Method;
constexpr Method kMethods[] = {Method::cochran2007, Method::screen, Method::sides};

/// A wall of lights at x = -3, a floor of 6 m, and what stands on the way; bounds and bodies on cells of 0.25 m.
struct Street {
  Scene scene;
  Street() {
    const int grey = add_material(scene, glm::vec3(0.7f));
    add_quad(scene, grey, {-3, 0, -3}, {0, 0, 6}, {6, 0, 0});
    add_quad(scene, grey, {-3, 0, 3}, {0, 0, -6}, {0, 2, 0});
    update_bounds(scene);
  }
  Street& body(glm::vec3 bottom_middle, glm::vec3 size, float turn_rad = 0.0f) {
    add_box(scene, 0, bottom_middle, size, turn_rad);
    return *this;
  }
  /// From behind the bodies, so that it sees where light leaves them and their shadows.
  Camera camera() const {
    return look_at_camera({2.9f, 3.0f, 2.0f}, {0.9f, 0.2f, 0.0f}, 0.9f, scene.bounds_min, scene.bounds_max);
  }
};

/// n x n lights on a square of the wall around (y, z) = (1.25, 0).
std::vector<VirtualLight> wall_lights(int n, float edge_m) {
  std::vector<VirtualLight> lights;
  for (int i = 0; i < n * n; ++i) {
    const glm::vec2 at = (glm::vec2(i % n, i / n) + 0.5f) / float(n) - 0.5f;
    lights.push_back(light_at({-3.0f, 1.25f + edge_m * at.x, edge_m * at.y}, {1, 0, 0}, glm::vec3(3, 2, 1), 1e-4f));
  }
  return lights;
}

class Placed {
 public:
  Placed(const gl::Context& context, const Scene& scene, const Camera& camera, const VirtualLightListGl& lights,
         const NegativeLightOptions& options, glm::ivec2 size = {96, 72}, int grid_cells = 24)
      : seen(context, scene, camera, size), negative(options) {
    if (options.method == Method::sides) voxels_ = upload(voxelize_cpu(scene, make_grid(scene, grid_cells)));
    negative.run(seen.gbuffer, camera, lights, options.method == Method::sides ? &voxels_ : nullptr, seen.timer);
  }
  glm::dvec3 flux() const {
    glm::dvec3 sum(0.0);
    for (const shared::NegativeLight& l : negative.download()) sum += glm::dvec3(l.flux);
    return sum;
  }
  Seen seen;
  NegativeLights negative;

 private:
  VoxelGridGl voxels_;
};

/// Share of a light's flux that meets one of the meshes from `first_body` on: rays spread as the cosine.
double intercepted_share(const Scene& scene, const VirtualLight& light, size_t first_body) {
  const EmbreeScene rays(scene);
  const glm::vec3 up(0, 1, 0), right = glm::cross(light.normal, up);
  constexpr int n = 400;
  int hits = 0;
  for (int i = 0; i < n * n; ++i) {
    const glm::vec2 at = (glm::vec2(i % n, i / n) + 0.5f) / float(n);
    const float r = std::sqrt(at.x), phi = glm::two_pi<float>() * at.y;
    const glm::vec3 d = r * std::cos(phi) * right + r * std::sin(phi) * up + std::sqrt(1.0f - at.x) * light.normal;
    RayHit hit;
    hits += rays.intersect(light.position + 1e-3f * light.normal, d, 100.0f, 0, hit) && hit.mesh >= first_body;
  }
  return double(hits) / double(n * n);
}

/// Irradiance of all lights over those that Embree says are seen, as radiance.
glm::dvec3 visible_radiance(const EmbreeScene& rays, const std::vector<VirtualLight>& lights, const Seen& seen,
                            size_t pixel, bool& all_hidden) {
  std::vector<VirtualLight> visible;
  const glm::vec3 at = glm::vec3(seen.position[pixel]) + 1e-3f * glm::vec3(seen.geometric(pixel));
  for (const VirtualLight& l : lights) {
    const glm::vec3 way = l.position + 1e-3f * l.normal - at;
    const float distance = glm::length(way);
    if (!rays.occluded(at, way / distance, distance, 0)) visible.push_back(l);
  }
  all_hidden = visible.empty();
  return radiance_of(visible, seen, pixel);
}

struct Shadow {
  double left = 0.0;   // of the light in the umbra on the floor
  double error = 0.0;  // root mean square on the floor, of that without negative lights
};

Shadow shadow_of(const gl::Context& context, const Street& street, const std::vector<VirtualLight>& lights,
                 const NegativeLightOptions& options) {
  const VirtualLightListGl list = list_of(lights);
  Placed placed(context, street.scene, street.camera(), list, options);
  const EmbreeScene rays(street.scene);
  const Gathered plain = gathered(placed.seen, list, every_pixel());
  const Gathered less = gathered(placed.seen, list, every_pixel(), &placed.negative);
  double umbra = 0.0, umbra_plain = 0.0, squares = 0.0, squares_plain = 0.0;
  int hidden = 0;
  for (size_t i = 0; i < placed.seen.position.size(); ++i) {
    EXPECT_TRUE(std::isfinite(less.indirect[i].x) && glm::all(glm::greaterThanEqual(less.indirect[i], glm::vec4(0))));
    if (placed.seen.position[i].w == 0.0f || placed.seen.position[i].y > 1e-3f) continue;
    bool all_hidden = false;
    const double exact = visible_radiance(rays, lights, placed.seen, i, all_hidden).r;
    squares += std::pow(double(less.indirect[i].r) - exact, 2);
    squares_plain += std::pow(double(plain.indirect[i].r) - exact, 2);
    if (!all_hidden) continue;
    ++hidden;
    umbra += double(less.indirect[i].r);
    umbra_plain += double(plain.indirect[i].r);
  }
  EXPECT_GT(hidden, 300);
  return {umbra / umbra_plain, std::sqrt(squares / squares_plain)};
}

// Lobes are as narrow as the light that passes: the spots of 256 of them cover a shadow where lights are spread as wide
// as the body (half the umbra is left where they are not).
TEST_F(NegativeLightsTest, TakeMostOfTheLightInAShadow) {
  const Street street = Street().body({0, 0.25f, 0}, {1, 1, 1});
  const struct {
    float edge_m;
    double left, error;  // limits for Method::sides, a tenth above what is reached
  } rows[] = {{0.05f, 0.60, 0.78}, {0.5f, 0.52, 0.68}, {1.5f, 0.05, 0.22}};
  for (const auto& row : rows) {
    const auto lights = wall_lights(8, row.edge_m);
    for (const Method method : kMethods) {
      const Shadow shadow = shadow_of(context(), street, lights, {256, method});
      const std::string key = std::to_string(int(method)) + "_" + std::to_string(row.edge_m);
      RecordProperty("left_" + key, std::to_string(shadow.left));
      RecordProperty("error_" + key, std::to_string(shadow.error));
      EXPECT_LT(shadow.left, method == Method::sides ? row.left : 0.7) << key;
      EXPECT_LT(shadow.error, method == Method::sides ? row.error : 0.9) << key;
    }
  }
}

// Also not where normals and depths are rounded, and not what lies in one plane.
TEST_F(NegativeLightsTest, TakeNothingFromAConvexRoom) {
  for (const float turn_rad : {0.0f, 0.7f}) {
    const glm::mat3 turn(glm::rotate(glm::mat4(1.0f), turn_rad, glm::normalize(glm::vec3(1.0f, 2.0f, -1.0f))));
    Scene scene = colourful_room();
    for (Mesh& mesh : scene.meshes) {
      for (glm::vec3& p : mesh.positions) p = turn * p;
      for (glm::vec3& n : mesh.normals) n = turn * n;
    }
    update_bounds(scene);
    scene.lights = {point_light(turn * kLamp, 2.5f)};
    Frames frames(context(), scene, {512, {}, Sampling::halton});
    const VirtualLightListGl& lights = frames.run().list();
    const Camera camera = look_at_camera(turn * glm::vec3(-0.8f, 0.6f, -1.3f), turn * glm::vec3(0.3f, -0.3f, 0.5f),
                                         1.2f, scene.bounds_min, scene.bounds_max);
    for (const Method method : kMethods) {
      Placed placed(context(), scene, camera, lights, {256, method});
      const Gathered plain = gathered(placed.seen, lights, every_pixel());
      const Gathered less = gathered(placed.seen, lights, every_pixel(), &placed.negative);
      const double taken = placed.flux().r / sum_of_flux(download(lights)).r;
      // Sides' depths are rounded to 1/384 of a cell, so that neighbours on a slope may look a little behind it.
      const double rounding = method == Method::sides && turn_rad != 0.0f ? 1e-5 : 0.0;
      EXPECT_LE(taken, rounding) << int(method) << ' ' << turn_rad;
      if (rounding > 0.0) continue;
      EXPECT_TRUE(plain.indirect == less.indirect) << int(method) << ' ' << turn_rad;
    }
  }
}

// All light that bodies stop leaves them somewhere: the sides' flux is what Embree says they meet.
TEST_F(NegativeLightsTest, FluxOfSidesIsWhatTheBodyIntercepts) {
  const VirtualLight light = light_at({-3.0f, 0.6f, 0.1f}, {1, 0, 0}, glm::vec3(3.0f), 1e-6f);
  const struct {
    const char* name;
    Street street;
    double tolerance;
  } cases[] = {
      {"aligned", Street().body({0, 0.25f, 0}, {1, 1, 1}), 0.01},
      {"turned", Street().body({0.1f, 0.31f, 0.07f}, {1, 0.9f, 1.1f}, 0.6f), 0.08},
      {"hidden_one_behind", Street().body({0, 0.25f, 0}, {1, 1, 1}).body({1.5f, 0.5f, 0}, {0.5f, 0.5f, 0.5f}), 0.01},
      {"larger_one_behind", Street().body({0, 0.25f, 0}, {1, 1, 1}).body({1.75f, 0.25f, 0}, {0.5f, 1.5f, 5}), 0.05},
      {"beside", Street().body({0, 0.25f, -1}, {1, 1, 1}).body({0, 0.25f, 1}, {1, 1, 1}), 0.01}};
  for (const auto& c : cases) {
    const double exact = 3.0 * intercepted_share(c.street.scene, light, 2);
    Placed placed(context(), c.street.scene, c.street.camera(), list_of({light}), {1024, Method::sides}, {8, 8});
    RecordProperty(c.name, std::to_string(placed.flux().r / exact));
    EXPECT_GT(exact, 0.03);
    EXPECT_NEAR(placed.flux().r / exact, 1.0, c.tolerance) << c.name;
  }
}

// A body in another's shadow has nothing to stop.
TEST_F(NegativeLightsTest, NothingIsTakenTwice) {
  const Street street = Street().body({0, 0.25f, 0}, {1, 1, 1}).body({1.5f, 0.5f, 0}, {0.5f, 0.5f, 0.5f});
  const VirtualLight light = light_at({-3.0f, 0.7f, 0.0f}, {1, 0, 0});
  Placed placed(context(), street.scene, street.camera(), list_of({light}), {1024, Method::sides}, {8, 8});
  int first = 0;
  for (const shared::NegativeLight& l : placed.negative.download()) {
    if (l.flux == glm::vec3(0.0f)) continue;
    EXPECT_LT(l.position.x, 0.51f);
    ++first;
  }
  EXPECT_GT(first, 300);
}

// Every pixel of a plate with lights behind it passes light, so that all of the sequence is there to be seen.
TEST_F(NegativeLightsTest, ThePapersStandOnPixelsOfTheHaltonSequence) {
  Scene scene;
  add_quad(scene, add_material(scene, glm::vec3(0.7f)), {-4, -4, 0}, {8, 0, 0}, {0, 8, 0});
  update_bounds(scene);
  const Camera camera = look_at_camera({0.4f, 0.2f, 3}, {0, 0, 0}, 0.9f, {-4, -4, -2}, {4, 4, 2});
  const std::vector<VirtualLight> lights = {light_at({-0.5f, 0, -1}, {0.1f, 0, 1}, {3, 2, 1}, 0.1f),
                                            light_at({0.8f, 0.3f, -2}, {-0.2f, 0, 1}, {1, 2, 3}, 0.2f)};
  const glm::ivec2 size(61, 47);
  Placed placed(context(), scene, camera, list_of(lights), {60, Method::cochran2007}, size);
  const auto negative = placed.negative.download();
  for (unsigned k = 0; k < 60; ++k) {
    const glm::ivec2 pixel = glm::ivec2(halton(k + 1) * glm::dvec2(size));
    const size_t i = size_t(pixel.x) + size_t(size.x) * size_t(pixel.y);
    EXPECT_EQ(negative[k].position, glm::vec3(placed.seen.position[i])) << k;
    EXPECT_EQ(negative[k].exponent, 1.0f);
    glm::dvec3 irradiance(0.0), direction(0.0);
    for (const VirtualLight& l : lights) {
      const glm::dvec3 way = glm::dvec3(placed.seen.position[i]) - glm::dvec3(l.position);
      const double d = glm::length(way);
      const glm::dvec3 e = glm::dvec3(l.flux) * (way.z / d * glm::dot(way, glm::dvec3(l.normal)) / d /
                                                 (glm::pi<double>() * d * d + double(l.area_m2)));
      irradiance += e;
      direction += glm::dot(e, glm::dvec3(0.2126, 0.7152, 0.0722)) / d * way;
    }
    const CameraRay ray = camera_ray(camera, glm::vec2(pixel.x, size.y - 1 - pixel.y) + 0.5f, size);
    const CameraRay right = camera_ray(camera, glm::vec2(pixel.x, size.y - 1 - pixel.y) + glm::vec2(1.0f, 0.5f), size);
    const CameraRay down = camera_ray(camera, glm::vec2(pixel.x, size.y - 1 - pixel.y) + glm::vec2(0.5f, 1.0f), size);
    const auto met = [&](const CameraRay& r) {
      return glm::dvec3(r.origin) - glm::dvec3(r.direction) * (double(r.origin.z) / double(r.direction.z));
    };
    const double pixel_m2 = 4.0 * glm::length(glm::cross(met(right) - met(ray), met(down) - met(ray)));
    EXPECT_NEAR(double(negative[k].area_m2) / (pixel_m2 * size.x * size.y / 60.0), 1.0, 0.03) << k;
    EXPECT_NEAR(glm::dot(glm::dvec3(negative[k].direction), glm::normalize(direction)), 1.0, 1e-6) << k;
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(double(negative[k].flux[c]) / (irradiance[c] * double(negative[k].area_m2)), 1.0, 1e-4) << k;
  }
}

/// The cells that open_cells*.comp.glsl find, as NegativeLights::run asks for them.
std::vector<std::uint32_t> open_cells(const VoxelGridGl& voxels, const VirtualLightListGl& lights, int rounds) {
  const gl::Program seed = gl::Program::compute("screen/visibility/negative/open_cells_seed.comp.glsl");
  const gl::Buffer open(cell_count(voxels.grid) * sizeof(GLuint));
  open.clear();
  voxels.bind();
  lights.buffer.bind_storage(VIRTUAL_LIGHTS_SLOT);
  open.bind_storage(OPEN_CELLS_SLOT);
  seed.use();
  seed.set("light_count", lights.reflected);
  gl::dispatch_linear(size_t(lights.reflected), LINEAR_GROUP);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  CellSpreadGl().run(voxels, open, rounds);
  return open.download<std::uint32_t>(cell_count(voxels.grid));
}

TEST_F(NegativeLightsTest, OpenCellsAreThoseThatLightCanReach) {
  Scene scene = colourful_room();
  add_box(scene, 0, {0.3f, -0.55f, 0.2f}, {0.6f, 0.6f, 0.5f}, 0.5f);    // floats, closed
  add_quad(scene, 0, {-1, -0.75f, -0.6f}, {1.5f, 0, 0}, {0, 1.5f, 0});  // two walls with ways around them
  add_quad(scene, 0, {-0.5f, -0.75f, -1.0f}, {1.5f, 0, 0}, {0, 1.5f, 0});
  update_bounds(scene);
  const VoxelGridGl voxels = upload(voxelize_cpu(scene, make_grid(scene, 30)));
  const VirtualLightListGl lights =
      list_of({light_at({-1, 0, 1}, {1, 0, 0}), light_at({0.31f, -0.2f, 0.21f}, {0, 1, 0}, glm::vec3(0))});
  const Voxels cpu = downloaded(voxels);
  std::vector<char> reached(cpu.cells.size(), 0);
  reached[size_t(shared::cell_index(cpu.grid, glm::ivec3(shared::cell_from_world(cpu.grid, {-0.99f, 0.0f, 1.0f}))))] =
      1;
  reached = cpu.flood(reached);
  const auto open = open_cells(voxels, lights, 6);
  int missed = 0, closed = 0;
  for (size_t i = 0; i < open.size(); ++i) {
    EXPECT_LE(open[i], std::uint32_t(reached[i])) << i;
    missed += open[i] == 0 && reached[i] != 0;
    closed += reached[i] == 0;
  }
  EXPECT_EQ(missed, 0);
  EXPECT_GT(closed, 30);  // in the box
  const glm::ivec3 inside = glm::ivec3(shared::cell_from_world(cpu.grid, {0.3f, -0.25f, 0.2f}));
  EXPECT_EQ(open[size_t(shared::cell_index(cpu.grid, inside))], 0u);
}

}  // namespace
}  // namespace volgi::test
