// Depth maps of area lights against rays: every texel sees what a ray along its direction meets.
#include <algorithm>
#include <filesystem>
#include <limits>

#include "tests/screen/visibility/area_maps/area_light_scene.h"
#include "tests/support/paths.h"

namespace volgi::test {
namespace {

constexpr float kNothing = std::numeric_limits<float>::infinity();

float ray_distance(const EmbreeScene& embree, glm::vec3 origin, glm::vec3 direction) {
  RayHit hit;
  return embree.intersect(origin, glm::normalize(direction), kNothing, 0, hit) ? hit.distance : kNothing;
}

/// Whether `distance` lies between what rays meet that differ by rounding: on an edge either side is right.
bool agrees(const EmbreeScene& embree, glm::vec3 origin, glm::vec3 direction, float distance) {
  constexpr float turn_rad = 1e-4f;  // a hundredth of a texel
  float low = kNothing, high = 0.0f;
  for (int k = 0; k < 9; ++k) {
    const glm::vec3 d = direction + turn_rad * glm::vec3(k % 3 - 1, k / 3 - 1, (k * 2) % 3 - 1);
    const float t = ray_distance(embree, origin, d);
    low = std::min(low, t);
    high = std::max(high, t);
  }
  return distance >= low * (1.0f - 1e-4f) && distance <= high * (1.0f + 1e-4f);
}

struct Comparison {
  int texels = 0, hits = 0, unlike = 0;
  int edges = 0;  // of those that agree only with a turned ray
};

Comparison compare(const EmbreeScene& embree, const shared::VirtualAreaLight& light, const float* distances,
                   int resolution) {
  Comparison c;
  for (int y = 0; y < resolution; ++y) {
    for (int x = 0; x < resolution; ++x) {
      const float distance = distances[y * resolution + x];
      const glm::vec2 disk = disk_of_texel(x, y, resolution);
      if (glm::dot(disk, disk) > 1.0f) {
        EXPECT_EQ(distance, kNothing) << "outside the disk";
        continue;
      }
      const glm::vec3 d = world_from_area_light(light, shared::direction_from_paraboloid(disk));
      const float expected = ray_distance(embree, light.position, d);
      ++c.texels;
      if (expected < kNothing) ++c.hits;
      if (distance == expected || std::abs(distance - expected) <= 1e-5f * expected) continue;
      ++c.edges;
      if (agrees(embree, light.position, d, distance)) continue;
      if (++c.unlike <= 3) {
        ADD_FAILURE() << "texel " << x << ", " << y << ": " << distance << " and a ray " << expected;
      }
    }
  }
  return c;
}

using ParaboloidDepthMaps = GlTest;

void expect_rays(const gl::Context& context, const Scene& scene, const std::vector<shared::VirtualAreaLight>& lights,
                 int resolution, double min_hits) {
  AreaLightMaps maps(context, scene, lights, resolution);
  const EmbreeScene embree(scene);
  const std::vector<float> distances = maps.distances();
  Comparison all;
  for (size_t k = 0; k < lights.size(); ++k) {
    const size_t layer = k * size_t(resolution) * size_t(resolution);
    const Comparison c = compare(embree, lights[k], distances.data() + layer, resolution);
    all.texels += c.texels;
    all.hits += c.hits;
    all.unlike += c.unlike;
    all.edges += c.edges;
  }
  EXPECT_EQ(all.unlike, 0);
  EXPECT_GE(all.hits, min_hits * all.texels);
  EXPECT_LE(all.edges, 0.02 * all.texels);
}

TEST_F(ParaboloidDepthMaps, SeeTheCornellBox) {
  const Scene scene = load_scene(source_dir() / "data/cornell.glb");
  const glm::vec3 middle = 0.5f * (scene.bounds_min + scene.bounds_max);
  const glm::vec3 half = 0.5f * (scene.bounds_max - scene.bounds_min);
  expect_rays(context(), scene,
              {area_light({middle.x, scene.bounds_min.y, middle.z}, {0, 1, 0}),
               area_light({scene.bounds_min.x, middle.y, middle.z}, {1, 0, 0}),
               area_light(middle + 0.3f * half, {0.3f, -0.8f, 0.2f}), area_light(middle, {-1, 1, 1})},
              128, 0.5);
}

/// Two triangles of 2 km, tilted so that they cross the horizon of a light above or under them.
Scene huge_plane(glm::vec3 normal) {
  Scene scene;
  const glm::vec3 u = glm::normalize(glm::cross(normal, glm::vec3(0.3f, 0.1f, 0.9f)));
  const glm::vec3 v = glm::normalize(glm::cross(normal, u));
  add_quad(scene, add_material(scene, glm::vec3(0.5f)), -1000.0f * (u + v), 2000.0f * u, 2000.0f * v);
  update_bounds(scene);
  return scene;
}

TEST_F(ParaboloidDepthMaps, HugeTrianglesReachTheRim) {
  for (const glm::vec3 tilt :
       {glm::vec3(0, 1, 0), glm::vec3(0.3f, 1, 0.1f), glm::vec3(1, 0.2f, 0), glm::vec3(1, 0, 0)}) {
    const Scene scene = huge_plane(tilt);
    const glm::vec3 at = 1.5f * glm::normalize(tilt);
    const std::vector lights{area_light(at, {0, -1, 0}), area_light(at, {0, 1, 0}),
                             area_light(at, {0.7f, -0.7f, 0.3f})};
    AreaLightMaps maps(context(), scene, lights, 96);
    const std::vector<float> distances = maps.distances();
    for (size_t k = 0; k < lights.size(); ++k) {
      for (int i = 0; i < 96 * 96; ++i) {
        const glm::vec2 disk = disk_of_texel(i % 96, i / 96, 96);
        if (glm::dot(disk, disk) > 1.0f) continue;
        const glm::vec3 d = world_from_area_light(lights[k], shared::direction_from_paraboloid(disk));
        const float cosine = -glm::dot(d, glm::normalize(tilt));
        const float distance = distances[k * 96 * 96 + size_t(i)];
        if (cosine > 0.002f) {
          EXPECT_NEAR(distance * cosine / 1.5f, 1.0f, 2e-3f) << i;
        } else if (cosine < -1e-5f) {
          EXPECT_EQ(distance, kNothing) << i;
        }
      }
    }
  }
}

TEST_F(ParaboloidDepthMaps, OneTriangleAcrossTheRim) {
  Scene scene;
  Mesh& mesh = add_mesh(scene, add_material(scene, glm::vec3(0.5f)));
  mesh.positions = {{-3, 2, 1}, {4, -5, 0.5f}, {0.5f, 0.2f, -6}};
  mesh.normals.assign(3, {0, 1, 0});
  mesh.triangles = {{0, 1, 2}};
  update_bounds(scene);
  std::vector<shared::VirtualAreaLight> lights;
  for (int i = 0; i < 12; ++i) {
    const auto angle = float(i);
    lights.push_back(area_light({0.1f, 0.2f, 0.3f}, {std::sin(angle), std::cos(2 * angle), std::cos(angle)}));
  }
  expect_rays(context(), scene, lights, 64, 0.1);
}

TEST_F(ParaboloidDepthMaps, FineMeshesHaveNoHoles) {
  Scene scene;
  add_sphere(scene, add_material(scene, glm::vec3(0.5f)), {}, 3.0f, 150);  // 45 k triangles, under a texel each
  update_bounds(scene);
  expect_rays(context(), scene, {area_light({0.4f, -0.3f, 0.2f}, {0.2f, 0.9f, -0.3f}), area_light({}, {0, 1, 0})}, 128,
              1.0);
}

// More large triangles than the list of tiles has room for, the nearest last: llvmpipe ended their drawing after 65535
// turns, and light came through.
TEST_F(ParaboloidDepthMaps, ManyLargeTrianglesInFineMaps) {
  constexpr int resolution = 512, sheets = 96, lights = 8;
  Scene scene;
  const int grey = add_material(scene, glm::vec3(0.5f));
  for (int k = sheets; k > 0; --k)
    add_quad(scene, grey, {-1000.0f, 1.0f + 0.01f * float(k), -1000.0f}, {2000.0f, 0, 0}, {0, 0, 2000.0f});
  AreaLightMaps maps(context(), scene, std::vector(lights, area_light(glm::vec3(0.0f), {0, 1, 0})), resolution);
  const std::vector<float> distances = maps.distances();
  int wrong = 0;
  for (int i = 0; i < resolution * resolution * lights; ++i) {
    const glm::vec2 disk = disk_of_texel(i % resolution, i / resolution % resolution, resolution);
    const float cosine = (1.0f - glm::dot(disk, disk)) / (1.0f + glm::dot(disk, disk));
    if (cosine > 0.01f && std::abs(distances[size_t(i)] * cosine / 1.01f - 1.0f) > 1e-3f) ++wrong;
  }
  EXPECT_EQ(wrong, 0);
}

TEST_F(ParaboloidDepthMaps, TheSurfaceOfTheLightDoesNotHideIt) {
  Scene scene;
  const int grey = add_material(scene, glm::vec3(0.5f));
  const glm::vec3 u = glm::normalize(glm::vec3(1, 0.3f, -0.2f));
  const glm::vec3 v = glm::normalize(glm::cross(u, glm::vec3(0.1f, 0.2f, 1)));
  const glm::vec3 n = glm::cross(u, v);
  const glm::vec3 origin(7.3f, 2.1f, -3.7f);
  Mesh& mesh = add_mesh(scene, grey);
  for (int i = 0; i < 100; ++i) {
    const int column = i % 10, row = i / 10;
    append_quad(mesh, origin + 0.1f * (float(column) * u + float(row) * v), 0.1f * u, 0.1f * v);
  }
  update_bounds(scene);
  std::vector<shared::VirtualAreaLight> lights;
  for (int i = 0; i < 30; ++i) {
    const glm::vec2 at(std::fmod(0.37f * float(i), 1.0f), std::fmod(0.61f * float(i), 1.0f));
    lights.push_back(area_light(origin + at.x * u + at.y * v, n + 0.05f * float(i % 3) * u));
  }
  AreaLightMaps maps(context(), scene, lights, 64);
  const std::vector<float> distances = maps.distances();
  EXPECT_EQ(std::count(distances.begin(), distances.end(), kNothing), std::ptrdiff_t(distances.size()));
}

TEST_F(ParaboloidDepthMaps, CutOutsAreHolesAndGlassIsCoverage) {
  for (const AlphaMode mode : {AlphaMode::mask, AlphaMode::blend}) {
    Scene scene;
    Material material;
    material.metallic_factor = 0.0f;
    material.alpha_mode = mode;
    material.base_color.texture = 0;
    scene.materials.push_back(material);
    TextureImage image{4, 4, {}};
    const int clear_alpha = mode == AlphaMode::mask ? 0 : 102;  // 0.4
    for (int i = 0; i < 16; ++i) {
      const bool hole = i % 4 >= 2;
      image.rgba.edit().insert(image.rgba.edit().end(), {255, 255, 255, std::uint8_t(hole ? clear_alpha : 255)});
    }
    scene.images.push_back(image);
    scene.textures.push_back({0, {}});
    scene.textures[0].sampler.magnify_nearest = true;
    const int opaque = add_material(scene, glm::vec3(0.5f));
    add_quad(scene, 0, {-1, 1, -1}, {2, 0, 0}, {0, 0, 2});
    add_quad(scene, opaque, {-9, 2, -9}, {18, 0, 0}, {0, 0, 18});
    update_bounds(scene);
    const auto light = area_light({0.013f, 0, 0.007f}, {0, 1, 0});
    AreaLightMaps maps(context(), scene, {light}, 128);
    const std::vector<float> distances = maps.distances();
    int solid = 0, solid_seen = 0, hole = 0, hole_seen = 0;
    for (int i = 0; i < 128 * 128; ++i) {
      const glm::vec2 disk = disk_of_texel(i % 128, i / 128, 128);
      const glm::vec3 d = world_from_area_light(light, shared::direction_from_paraboloid(disk));
      if (d.y < 0.2f) continue;
      const glm::vec3 p = light.position + d / d.y;
      if (std::max(std::abs(p.x), std::abs(p.z)) > 0.99f || std::abs(p.x) < 0.01f) continue;
      const bool near = std::abs(distances[size_t(i)] * d.y - 1.0f) < 1e-3f;
      EXPECT_NEAR(distances[size_t(i)] * d.y, near ? 1.0f : 2.0f, 1e-3f);
      ++(p.x > 0.0f ? hole : solid);
      if (near) ++(p.x > 0.0f ? hole_seen : solid_seen);
    }
    EXPECT_GT(hole, 500);
    EXPECT_EQ(solid_seen, solid);
    const double expected = mode == AlphaMode::mask ? 0.0 : 0.4;
    EXPECT_NEAR(double(hole_seen) / hole, expected, 3.0 * std::sqrt(expected * (1 - expected) / hole));
  }
}

TEST_F(ParaboloidDepthMaps, LayersAreIndependentAndEmptyClustersSeeNothing) {
  const Scene scene = stage();
  std::vector lights{area_light({0, 0, 0}, {0, 1, 0}), area_light({-0.5f, 0.7f, 0.2f}, {0.2f, 0, 1}),
                     area_light({0.1f, 2, 0.4f}, {0, -1, 0})};
  constexpr size_t layer = 64 * 64;
  const std::vector<float> together = AreaLightMaps(context(), scene, lights, 64).distances();
  for (size_t k = 0; k < 3; ++k) {
    const std::vector<float> alone = AreaLightMaps(context(), scene, {lights[k]}, 64).distances();
    EXPECT_TRUE(std::equal(alone.begin(), alone.end(), together.begin() + std::ptrdiff_t(k * layer)));
  }
  lights[1].light_count = 0;
  const std::vector<float> without = AreaLightMaps(context(), scene, lights, 64).distances();
  for (size_t i = 0; i < 3 * layer; ++i) EXPECT_EQ(without[i], i / layer == 1 ? kNothing : together[i]);
}

TEST_F(ParaboloidDepthMaps, TheSameTwiceAndAfterAnother) {
  const Scene scene = stage();
  AreaLightMaps maps(context(), scene, {area_light({0, 0, 0.9f}, {0, 1, 0}), area_light({0, 1, -1}, {0, 0, 1})}, 100);
  const std::vector<float> first = maps.distances();
  maps.run();
  EXPECT_EQ(maps.distances(), first);
}

}  // namespace
}  // namespace volgi::test
