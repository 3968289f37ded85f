// What holds for any picture: bytes, halves, layers, and light that must not be there.
#include "reference/path_tracer.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>
#include <string>

#include "core/surface.h"
#include "core/visibility/embree_scene.h"
#include "reference/picture_files.h"
#include "reference/progressive_path_tracer.h"
#include "reference/sampler.h"
#include "scenes.h"

namespace volgi {
namespace {

using namespace test;

Scene lit_box() {
  Scene scene;
  add_box_inside(scene, add_material(scene, {0.8f, 0.6f, 0.4f}), {}, glm::vec3(1.0f));
  add_quad(scene, add_material(scene, glm::vec3(0.5f), glm::vec3(3.0f)), {0, 0.95f, 0}, {0.3f, 0, 0}, {0, 0, 0.3f});
  const int veil = add_material(scene, glm::vec3(0.9f));
  scene.materials[static_cast<size_t>(veil)].alpha_mode = AlphaMode::blend;
  scene.materials[static_cast<size_t>(veil)].base_color_factor.w = 0.5f;
  add_quad(scene, veil, {0, 0, -0.4f}, {0.5f, 0, 0}, {0, 0.5f, 0});
  scene.lights = {point_light({0.3f, 0, 0.4f}, glm::vec3(1.0f)), point_light({-0.5f, 0.2f, 0}, glm::vec3(0.5f)),
                  point_light({0, -0.5f, 0}, glm::vec3(0.2f))};
  return scene;
}

PathTracerOptions small(int spp) {
  PathTracerOptions options;
  options.size = {40, 28};
  options.samples_per_pixel = spp;
  return options;
}

const Camera kInside = camera_at({0.1f, 0.1f, 0.9f}, {0, 0, -1}, 1.0f);

bool same_bytes(const ReferencePicture& a, const ReferencePicture& b) {
  const ChannelImage x = to_channels(a), y = to_channels(b);
  if (x.channels.size() != y.channels.size()) return false;
  for (size_t i = 0; i < x.channels.size(); ++i)
    if (std::memcmp(x.channels[i].values.data(), y.channels[i].values.data(), 4 * x.channels[i].values.size()) != 0)
      return false;
  return true;
}

TEST(PathTracer, BytesDoNotDependOnThreads) {
  const Scene scene = lit_box();
  for (const auto filter : {PathTracerOptions::Filter::point, PathTracerOptions::Filter::box}) {
    PathTracerOptions options = small(8);
    options.filter = filter;
    options.threads = 1;
    const ReferencePicture one = path_trace(scene, kInside, options);
    options.threads = 2;
    EXPECT_TRUE(same_bytes(one, path_trace(scene, kInside, options)));
    options.seed = 2;
    EXPECT_FALSE(same_bytes(one, path_trace(scene, kInside, options)));
  }
}

TEST(PathTracer, HalvesDifferAndAverageToTheWhole) {
  const ReferencePicture p = path_trace(lit_box(), kInside, small(16));
  int different = 0;
  for (size_t i = 0; i < p.color.pixels.size(); ++i) {
    different += p.half_a.pixels[i] != p.half_b.pixels[i];
    for (int c = 0; c < 3; ++c) {
      const float whole = p.color.pixels[i][c];
      EXPECT_NEAR(0.5f * (p.half_a.pixels[i][c] + p.half_b.pixels[i][c]), whole, 1e-6f * whole);
      const float direct = p.direct.pixels[i][c];
      EXPECT_NEAR(0.5f * (p.direct_half_a.pixels[i][c] + p.direct_half_b.pixels[i][c]), direct, 1e-6f * direct);
    }
  }
  EXPECT_GT(different, 1000);
}

// The halves' difference predicts the error of the whole: checked against a picture with 32 times the samples.
TEST(PathTracer, HalvesMeasureTheNoise) {
  const Scene scene = lit_box();
  const ReferencePicture p = path_trace(scene, kInside, small(8));
  PathTracerOptions many = small(256);
  many.seed = 99;
  const ReferencePicture truth = path_trace(scene, kInside, many);
  double predicted = 0, actual = 0;
  for (size_t i = 0; i < p.color.pixels.size(); ++i) {
    const glm::vec3 n = 0.5f * (p.half_a.pixels[i] - p.half_b.pixels[i]), e = p.color.pixels[i] - truth.color.pixels[i];
    predicted += static_cast<double>(glm::dot(n, n));
    actual += static_cast<double>(glm::dot(e, e));
  }
  EXPECT_NEAR(std::sqrt(actual / predicted), 1.0, 0.12);
}

TEST(PathTracer, LightAskedForAddsUp) {
  const Scene scene = lit_box();
  PathTracerOptions options = small(8);
  const ReferencePicture full = path_trace(scene, kInside, options);
  options.light = PathTracerOptions::Light::indirect;
  const ReferencePicture indirect = path_trace(scene, kInside, options);
  options.light = PathTracerOptions::Light::direct;
  const ReferencePicture direct = path_trace(scene, kInside, options);
  for (size_t i = 0; i < full.color.pixels.size(); ++i) {
    const glm::vec3 sum = direct.color.pixels[i] + indirect.color.pixels[i];
    EXPECT_LT(glm::length(full.color.pixels[i] - sum), 1e-5f * glm::length(sum) + 1e-7f);
    EXPECT_EQ(direct.color.pixels[i], full.direct.pixels[i]);
  }
  EXPECT_NE(to_channels(full).find("direct.R"), nullptr);
  EXPECT_EQ(to_channels(indirect).find("direct.R"), nullptr);
  EXPECT_NE(to_channels(indirect).find("left_out.direct.R"), nullptr);
}

// Two lamps on either side of a wall, which ends in the middle of a black floor.
TEST(PathTracer, SaysWhichLightsReachAPixel) {
  Scene scene;
  add_quad(scene, add_material(scene, glm::vec3(0.0f)), {}, {2, 0, 0}, {0, 0, -2});
  add_quad(scene, 0, {0, 1, 1}, {0, 0, -1}, {0, 1, 0});
  scene.lights = {point_light({-1, 1, 1}, glm::vec3(1.0f)), point_light({1, 1, 1}, glm::vec3(1.0f))};
  const Camera above = camera_at({0, 10, 0}, {}, 0.5f, 2.0f);
  PathTracerOptions options = small(2);
  options.size = {16, 16};
  const std::vector<float> two = path_trace(scene, above, options).lit;
  const auto at = [](const std::vector<float>& lit, int x, int y) { return lit[static_cast<size_t>(16 * y + x)]; };
  EXPECT_EQ(at(two, 13, 14), 1.0f);  // right in the picture is +Z, up is +X
  EXPECT_EQ(at(two, 13, 1), 2.0f);
  EXPECT_EQ(at(two, 0, 8), 3.0f);
  std::vector<Light> many(25, point_light({0, -1, 0}, glm::vec3(1.0f)));  // below the floor
  many.push_back(scene.lights[0]);
  scene.lights = many;
  EXPECT_EQ(at(path_trace(scene, above, options).lit, 13, 14), 2.0f) << "light 25 has bit 25 mod 24";
}

// What compare reads back of a picture that was written: its light and its noise, apart as --light has them.
TEST(PathTracer, FileKeepsLightAndNoise) {
  const ReferencePicture p = path_trace(lit_box(), kInside, small(8));
  const std::string path = ::testing::TempDir() + "volgi_file_keeps_light_and_noise.exr";
  write_exr(path, to_channels(p));
  const ReferenceFile full = read_reference(path, PathTracerOptions::Light::full);
  const ReferenceFile indirect = read_reference(path, PathTracerOptions::Light::indirect);
  std::remove(path.c_str());
  ASSERT_TRUE(full.noise && full.layers && indirect.noise);
  EXPECT_EQ(full.layers->lit, p.lit);
  double noise = 0;
  for (size_t i = 0; i < p.color.pixels.size(); ++i) {
    const glm::vec3 n = 0.5f * (p.half_a.pixels[i] - p.half_b.pixels[i]);
    const glm::vec3 direct = 0.5f * (p.direct_half_a.pixels[i] - p.direct_half_b.pixels[i]);
    EXPECT_EQ(full.color.pixels[i], p.color.pixels[i]);
    EXPECT_EQ(full.noise->pixels[i], n);
    EXPECT_EQ(indirect.color.pixels[i], p.color.pixels[i] - p.direct.pixels[i]);
    EXPECT_EQ(indirect.noise->pixels[i], n - direct);
    noise += static_cast<double>(glm::dot(n, n));
  }
  EXPECT_GT(noise, 0.0);
}

// From three lights on, bounces ask one light, chosen by chance: the mean must stay the sum over the lights.
TEST(PathTracer, ManyLightsAreSampledWithoutBias) {
  Scene scene;
  add_box_inside(scene, add_material(scene, {0.8f, 0.6f, 0.4f}), {}, glm::vec3(1.0f));
  add_quad(scene, 0, {0.2f, 0, 0.1f}, {0.3f, 0, 0}, {0, 0.1f, 0.3f});
  std::vector<Light> lights;
  for (int i = 0; i < 6; ++i) {
    const auto x = static_cast<float>(i);
    lights.push_back(point_light({0.3f * x - 0.8f, 0.7f * std::sin(x), 0.7f * std::cos(x)}, glm::vec3(1.0f + x)));
  }
  PathTracerOptions options = small(128);
  options.light = PathTracerOptions::Light::indirect;
  const auto mean = [&] {
    glm::dvec3 sum(0.0);
    for (const glm::vec3& c : path_trace(scene, kInside, options).color.pixels) sum += glm::dvec3(c);
    return sum / static_cast<double>(options.size.x * options.size.y);
  };
  glm::dvec3 each(0.0);
  for (const Light& light : lights) {
    scene.lights = {light};
    each += mean();
  }
  scene.lights = lights;
  const glm::dvec3 together = mean();
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(together[c] / each[c], 1.0, 0.01) << c;
}

TEST(PathTracer, LayersOfTheFirstHit) {
  Scene scene;
  scene.world_origin = {100, 200, 300};
  add_quad(scene, add_material(scene, {0.1f, 0.2f, 0.3f}), {0, 0, -3}, {0.5f, 0, 0}, {0, 0.5f, 0});
  PathTracerOptions options = small(2);
  options.size = {8, 8};
  const ReferencePicture p = path_trace(scene, camera_at({0, 0, 1}, {0, 0, 0}, 0.5f), options);
  EXPECT_EQ(p.id[0], 0.0f);  // the quad fills half the picture's width
  const size_t i = 3 * 8 + 4;
  EXPECT_EQ(p.id[i], 1.0f);
  EXPECT_NEAR(p.depth[i], 4.0f, 1e-5f);
  EXPECT_NEAR(p.position.pixels[i].z, 297.0f, 1e-4f);
  EXPECT_NEAR(p.position.pixels[i].x, 100 + 4 * std::tan(0.25) / 8, 1e-4);
  EXPECT_NEAR(p.position.pixels[i].y, 200 + 4 * std::tan(0.25) / 8, 1e-4);
  EXPECT_EQ(p.normal.pixels[i], glm::vec3(0, 0, 1));
  EXPECT_EQ(p.albedo.pixels[i], glm::vec3(0.1f, 0.2f, 0.3f));
}

// Two closed rooms that share a wall without thickness; the walls' corners are turned so that nothing is aligned.
TEST(PathTracer, NothingLeaksThroughAWallWithoutThickness) {
  for (const float angle : {0.0f, 0.3f, 1.1f}) {
    Scene scene;
    const int white = add_material(scene, glm::vec3(0.95f));
    add_box_inside(scene, white, {}, {2, 1, 1});
    add_quad(scene, white, {}, {0, 1, 0}, {0, 0, 1});  // T-junctions with floor, ceiling and walls
    const glm::mat3 turn(glm::rotate(glm::mat4(1.0f), angle, glm::normalize(glm::vec3(1, 2, 3))));
    const glm::vec3 shift = angle * glm::vec3(3, -7, 5);
    for (Mesh& mesh : scene.meshes) {
      for (glm::vec3& p : mesh.positions) p = turn * p + shift;
      for (glm::vec3& n : mesh.normals) n = turn * n;
    }
    scene.lights = {point_light(turn * glm::vec3(-0.1f, -0.9f, 0.9f) + shift, glm::vec3(1.0f))};
    PathTracerOptions options = small(48);
    options.filter = PathTracerOptions::Filter::box;
    const Camera camera =
        camera_at(turn * glm::vec3(1.9f, 0.9f, 0.8f) + shift, turn * glm::vec3(0, -0.5f, 0) + shift, 1.2f);
    const ReferencePicture dark = path_trace(scene, camera, options);
    for (const glm::vec3& p : dark.color.pixels) ASSERT_EQ(p, glm::vec3(0.0f)) << "turned by " << angle;
    const Camera other =
        camera_at(turn * glm::vec3(-1.9f, 0.9f, 0.8f) + shift, turn * glm::vec3(0, -0.5f, 0) + shift, 1.2f);
    for (const glm::vec3& p : path_trace(scene, other, options).color.pixels) ASSERT_GT(p.x, 0.0f);
  }
}

// Neither acne on a quad's diagonal and coincident copies, nor light from behind through tilted shading normals.
TEST(PathTracer, SurfacesDoNotShadowThemselves) {
  Scene scene;
  const int white = add_material(scene, glm::vec3(1.0f));
  for (int copy = 0; copy < 2; ++copy) add_quad(scene, white, {100, 0, 100}, {0, 0, 1}, {1, 0, 0});
  scene.lights = {point_light({100, 0.02f, 100}, glm::vec3(1.0f))};
  PathTracerOptions options = small(2);
  options.size = {64, 64};
  const Image lit = path_trace(scene, camera_at({100, 0.05f, 102}, {100, 0, 100}, 0.4f), options).color;
  const ReferencePicture p = path_trace(scene, camera_at({100, 0.05f, 102}, {100, 0, 100}, 0.4f), options);
  int seen = 0;
  for (size_t i = 0; i < lit.pixels.size(); ++i) {
    if (p.id[i] == 0.0f) continue;
    ++seen;
    ASSERT_GT(lit.pixels[i].x, 0.0f);
  }
  EXPECT_GT(seen, 50);

  scene.meshes.resize(1);
  for (glm::vec3& n : scene.meshes[0].normals) n = glm::normalize(glm::vec3(3, 1, 0));
  scene.lights = {point_light({110, -0.5f, 100}, glm::vec3(1.0f))};  // below the plane, before the shading normal
  for (const glm::vec3& c : path_trace(scene, camera_at({100, 1, 102}, {100, 0, 100}, 0.4f), options).color.pixels)
    ASSERT_EQ(c, glm::vec3(0.0f));
}

TEST(PathTracer, EmptySceneIsBlack) {
  Scene scene;
  add_material(scene, glm::vec3(1.0f));
  for (const glm::vec3& c : path_trace(scene, kInside, small(2)).color.pixels) EXPECT_EQ(c, glm::vec3(0.0f));
}

double rms_difference(const Image& a, const Image& b) {
  double sum = 0;
  for (size_t i = 0; i < a.pixels.size(); ++i) {
    const glm::dvec3 d = glm::dvec3(a.pixels[i]) - glm::dvec3(b.pixels[i]);
    sum += glm::dot(d, d);
  }
  return std::sqrt(sum / static_cast<double>(a.pixels.size()));
}

// With BLEND, and without, where paths start at a vertex that is kept.
std::array<Scene, 2> with_and_without_veil() {
  std::array<Scene, 2> scenes{lit_box(), lit_box()};
  scenes[1].meshes.pop_back();
  return scenes;
}

TEST(ProgressivePathTracer, BytesDependNeitherOnStepsNorOnThreads) {
  for (const Scene& scene : with_and_without_veil()) {
    PathTracerOptions options = small(0);
    options.threads = 1;
    ProgressivePathTracer at_once(scene, kInside, options);
    at_once.trace(8);
    options.threads = 2;
    ProgressivePathTracer in_steps(scene, kInside, options);
    EXPECT_EQ(in_steps.image().pixels[0], glm::vec3(0.0f));
    for (const int samples : {1, 1, 6}) in_steps.trace(samples);
    EXPECT_EQ(in_steps.samples_per_pixel(), 8);
    const Image a = at_once.image(), b = in_steps.image();
    EXPECT_EQ(std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(glm::vec3)), 0);
  }
}

// Traced part by part, backwards, after another picture that was broken off.
TEST(ProgressivePathTracer, PartsMakeTheSameBytes) {
  for (const Scene& scene : with_and_without_veil()) {
    const PathTracerOptions options = small(0);
    ProgressivePathTracer whole(scene, kInside, options);
    whole.trace(3);
    PathTracerOptions other = options;
    other.size = {50, 20};
    other.light = PathTracerOptions::Light::direct;
    ProgressivePathTracer in_parts(scene, kInside, other);
    std::atomic<bool> cancelled{false};
    EXPECT_TRUE(in_parts.trace_part(0, cancelled));
    cancelled = true;
    EXPECT_FALSE(in_parts.trace_part(1, cancelled));
    cancelled = false;
    in_parts.restart(kInside, options);
    for (int sample = 0; sample < 3; ++sample) {
      for (int part = in_parts.part_count() - 1; part >= 0; --part) EXPECT_TRUE(in_parts.trace_part(part, cancelled));
      in_parts.finish_sample();
    }
    const Image a = whole.image(), b = in_parts.image();
    EXPECT_EQ(std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(glm::vec3)), 0);
    EXPECT_TRUE(whole.noise().pixels.empty());
  }
}

// The halves of path_trace(), in turn; sums are rounded in another order.
TEST(ProgressivePathTracer, TwoPointSetsAreTheHalvesOfPathTrace) {
  for (const Scene& scene : with_and_without_veil()) {
    const PathTracerOptions options = small(8);
    const ReferencePicture whole = path_trace(scene, kInside, options);
    ProgressivePathTracer tracer(scene, kInside, options, ProgressivePathTracer::PointSets::two);
    tracer.trace(1);
    EXPECT_TRUE(tracer.noise().pixels.empty());
    for (const int samples : {2, 5}) tracer.trace(samples);
    const Image image = tracer.image(), noise = tracer.noise();
    for (size_t i = 0; i < image.pixels.size(); ++i) {
      const glm::vec3 half_difference = 0.5f * (whole.half_a.pixels[i] - whole.half_b.pixels[i]);
      const float tolerance = 1e-6f * (1.0f + glm::length(whole.color.pixels[i]));
      ASSERT_LT(glm::distance(image.pixels[i], whole.color.pixels[i]), tolerance);
      ASSERT_LT(glm::distance(noise.pixels[i], half_difference), tolerance);
    }
  }
}

// Its error falls with the samples, and is not above that of path_trace(), whose two halves are stratified apart.
TEST(ProgressivePathTracer, ApproachesThePictureOfPathTrace) {
  PathTracerOptions options = small(128);
  for (const Scene& scene : with_and_without_veil()) {
    options.light = options.light == PathTracerOptions::Light::indirect ? PathTracerOptions::Light::full
                                                                        : PathTracerOptions::Light::indirect;
    options.seed = 99;
    options.samples_per_pixel = 128;
    const Image truth = path_trace(scene, kInside, options).color;
    options.seed = 1;
    ProgressivePathTracer tracer(scene, kInside, options);
    tracer.trace(1);
    const double after_one = rms_difference(tracer.image(), truth);
    tracer.trace(7);
    const double after_all = rms_difference(tracer.image(), truth);
    EXPECT_LT(after_all, 0.6 * after_one);
    options.samples_per_pixel = 8;
    EXPECT_LT(after_all, 1.1 * rms_difference(path_trace(scene, kInside, options).color, truth));
  }
}

TEST(EmbreeScene, BlindRaysStepOffTheirSurface) {
  Scene scene;
  add_quad(scene, add_material(scene, glm::vec3(1.0f)), {}, {0, 0, 1}, {1, 0, 0});
  const EmbreeScene rays(scene);
  EXPECT_FALSE(rays.occluded(glm::vec3(0.3f, 0, 0.2f), {0, 1, 0}, 10.0f, 0));
  EXPECT_FALSE(rays.occluded(glm::vec3(0.3f, 0, 0.2f), {0, -1, 0}, 10.0f, 0));
  RayHit hit;
  ASSERT_TRUE(rays.intersect(glm::vec3(0.3f, 2, 0.2f), {0, -1, 0}, 10.0f, 0, hit));
  EXPECT_FLOAT_EQ(hit.distance, 2.0f);
  EXPECT_FALSE(rays.intersect(glm::vec3(0.3f, 2, 0.2f), {0, -1, 0}, 1.9f, 0, hit));
}

// Rays that hit a wall's foot within a rounding of the wall start on the side that they came from.
TEST(EmbreeScene, RaysFromTheFootOfAWallStayInTheirRoom) {
  Scene scene;
  const int white = add_material(scene, glm::vec3(1.0f));
  const glm::mat3 turn(glm::rotate(glm::mat4(1.0f), 0.7f, glm::normalize(glm::vec3(1, 2, 3))));
  const glm::vec3 shift(3, -7, 5);
  const auto quad = [&](glm::vec3 centre, glm::vec3 a, glm::vec3 b) {
    add_quad(scene, white, turn * centre + shift, turn * a, turn * b);
  };
  quad({0, -1, 0}, {0, 0, 1}, {2, 0, 0});  // floor
  quad({}, {0, 0, 1}, {0, 1, 0});          // wall at x = 0
  const EmbreeScene rays(scene);
  int escaped = 0, hits = 0;
  for (std::uint32_t i = 0; i < 20000; ++i) {
    PathSampler sampler(5, i);
    const glm::vec2 a = sampler.next2(), b = sampler.next2();
    const glm::vec3 eye = turn * glm::vec3(0.2f + a.x, a.y - 0.9f, 0.5f) + shift;
    const glm::vec3 foot = turn * glm::vec3(1e-7f * b.x, -1.0f, b.y - 0.5f) + shift;
    Ray ray{eye, glm::normalize(foot - eye), 10.0f, 0, {}, {}};
    RayHit hit;
    if (!rays.intersect(ray, hit) || hit.mesh != 0) continue;
    ++hits;
    const glm::vec3 met = surface_point(scene, scene.meshes[0], hit.triangle, hit.u, hit.v).position;
    const glm::vec3 start = rays.leaving_point(met, ray.direction, hit.distance);
    const glm::vec3 beyond = turn * glm::vec3(-1, -0.5f, 0) + shift - start;
    escaped += !rays.occluded({start, glm::normalize(beyond), glm::length(beyond), 0, hit.index(), {}});
  }
  EXPECT_GT(hits, 1000);
  EXPECT_EQ(escaped, 0);
}

TEST(PathSampler, PointsAreStratifiedAndUniform) {
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    std::vector<int> cells(256), columns(256), rows(256);
    for (std::uint32_t i = 0; i < 256; ++i) {
      PathSampler sampler(hash(7, seed), i);
      sampler.seek(seed);
      const glm::vec2 p = sampler.next2();
      ASSERT_TRUE(p.x >= 0 && p.x < 1 && p.y >= 0 && p.y < 1);
      ++cells[static_cast<size_t>(p.x * 16) * 16 + static_cast<size_t>(p.y * 16)];
      ++columns[static_cast<size_t>(p.x * 256)];
      ++rows[static_cast<size_t>(p.y * 256)];
    }
    for (size_t i = 0; i < 256; ++i) EXPECT_TRUE(cells[i] == 1 && columns[i] == 1 && rows[i] == 1) << seed;
  }
}

}  // namespace
}  // namespace volgi
