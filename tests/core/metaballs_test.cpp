#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <numeric>
#include <set>

#include "core/error.h"
#include "core/marching_cubes.h"
#include "core/metaballs.h"
#include "core/scene_source.h"

namespace volgi {
namespace {

constexpr int kTimes = 64;  // over a period

double time_of(int i) { return Metaballs::kPeriod_s * i / kTimes; }

/// Edges that do not have exactly one triangle on each side, in opposite directions.
size_t open_edges(const std::vector<glm::uvec3>& triangles) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> directed;
  for (const glm::uvec3& t : triangles) {
    for (int c = 0; c < 3; ++c) ++directed[{t[c], t[(c + 1) % 3]}];
  }
  return size_t(std::count_if(directed.begin(), directed.end(), [&](const auto& entry) {
    const auto other = directed.find({entry.first.second, entry.first.first});
    return entry.second != 1 || other == directed.end() || other->second != 1;
  }));
}

/// Parts that no edge joins.
size_t components(const Mesh& mesh) {
  std::vector<std::uint32_t> parent(mesh.positions.size());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](std::uint32_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  for (const glm::uvec3& t : mesh.triangles) {
    parent[root(t.y)] = root(t.x);
    parent[root(t.z)] = root(t.x);
  }
  std::set<std::uint32_t> roots;
  for (std::uint32_t i = 0; i < parent.size(); ++i) roots.insert(root(i));
  return roots.size();
}

glm::vec3 area_vector(const Mesh& mesh, const glm::uvec3& t) {
  return glm::cross(mesh.positions[t.y] - mesh.positions[t.x], mesh.positions[t.z] - mesh.positions[t.x]);
}

TEST(MarchingCubes, ClosesEveryCellThatThereIs) {
  // All 256 cells beside all others: a random field on a lattice whose outer nodes are outside.
  FieldSamples field;
  field.nodes = {17, 16, 15};
  field.values.assign(17 * 16 * 15, -1.0f);
  std::uint32_t state = 1;
  for (int z = 1; z < 14; ++z)
    for (int y = 1; y < 15; ++y)
      for (int x = 1; x < 16; ++x) {
        state = state * 1664525u + 1013904223u;
        field.values[field.index({x, y, z})] = float(state >> 8) * 0x1p-23f - 1.0f;
      }
  const Isosurface surface = marching_cubes(field, [](glm::vec3) { return 0.0f; });
  EXPECT_GT(surface.triangles.size(), 5000u);
  EXPECT_EQ(open_edges(surface.triangles), 0u);
}

TEST(MarchingCubes, PlacesAndTurnsASphere) {
  FieldSamples field;
  field.nodes = glm::ivec3(21);
  field.origin = glm::vec3(-1.0f);
  field.spacing_m = 0.1f;
  const auto value = [](glm::vec3 p) { return 0.5f - glm::dot(p, p) * glm::dot(p, p); };
  for (int z = 0; z < 21; ++z)
    for (int y = 0; y < 21; ++y)
      for (int x = 0; x < 21; ++x) field.values.push_back(value(field.position({x, y, z})));
  const Isosurface surface = marching_cubes(field, value);
  const float radius = std::pow(0.5f, 0.25f);
  for (const glm::vec3& p : surface.positions) EXPECT_NEAR(glm::length(p), radius, 1e-3f * field.spacing_m);
  double volume = 0.0;
  for (const glm::uvec3& t : surface.triangles)
    volume += double(glm::dot(surface.positions[t.x], glm::cross(surface.positions[t.y], surface.positions[t.z]))) / 6;
  EXPECT_NEAR(volume, 4.0 / 3.0 * 3.14159265 * std::pow(0.5, 0.75), 0.02 * volume);
}

TEST(Metaballs, AreClosedAndOutwardOverThePeriod) {
  size_t vertices = 0, not_between = 0;
  for (int i = 0; i < kTimes; ++i) {
    const Scene scene = metaballs_scene(time_of(i));
    const Mesh& mesh = scene.meshes.back();
    ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
    EXPECT_EQ(open_edges(mesh.triangles), 0u) << time_of(i);
    EXPECT_GE(mesh.triangles.size(), 3000u) << time_of(i);
    EXPECT_LE(mesh.triangles.size(), 8000u) << time_of(i);
    const Metaballs metaballs(time_of(i));
    size_t against = 0;
    for (const glm::uvec3& t : mesh.triangles) {
      const glm::vec3 area = area_vector(mesh, t);
      EXPECT_GT(glm::length(area), 0.0f);
      against += size_t(glm::dot(area, mesh.normals[t.x] + mesh.normals[t.y] + mesh.normals[t.z]) <= 0.0f);
    }
    EXPECT_EQ(against, 0u) << time_of(i);
    for (size_t v = 0; v < mesh.positions.size(); ++v) {
      EXPECT_NEAR(glm::length(mesh.normals[v]), 1.0f, 1e-5f);
      const glm::vec3 step = 0.003f * mesh.normals[v];
      not_between += size_t(metaballs.value(mesh.positions[v] + step) >= 0.0f);
      not_between += size_t(metaballs.value(mesh.positions[v] - step) <= 0.0f);
    }
    vertices += mesh.positions.size();
  }
  // Where two balls are about to touch the field is flat, and curves away within a step.
  EXPECT_LE(not_between, vertices / 10000);
}

TEST(Metaballs, ChangeTheirTopologyAndStayInTheRoom) {
  std::set<size_t> counts;
  for (int i = 0; i < kTimes; ++i) {
    const Scene scene = metaballs_scene(time_of(i));
    counts.insert(components(scene.meshes.back()));
    for (const glm::vec3& p : scene.meshes.back().positions) {
      EXPECT_TRUE(glm::all(glm::lessThan(glm::abs(p), glm::vec3(0.999f)))) << time_of(i);
    }
    EXPECT_EQ(scene.bounds_min, glm::vec3(-1.0f));
    EXPECT_EQ(scene.bounds_max, glm::vec3(1.0f));
  }
  EXPECT_GE(counts.size(), 3u);
}

TEST(Metaballs, MoveToWhatTheyAreAtATime) {
  const SceneSource source("builtin:metaballs");
  EXPECT_TRUE(source.animated());
  Scene moved = source.at(0.25);
  source.move(moved, 5.5, source.bounds(5.5));
  const Scene made = load_scene("builtin:metaballs", 5.5);
  const Scene later = load_scene("builtin:metaballs", 5.5 + Metaballs::kPeriod_s);
  ASSERT_EQ(moved.meshes.size(), made.meshes.size());
  for (size_t m = 0; m < made.meshes.size(); ++m) {
    EXPECT_EQ(moved.meshes[m].positions, made.meshes[m].positions);
    EXPECT_EQ(moved.meshes[m].normals, made.meshes[m].normals);
    EXPECT_EQ(moved.meshes[m].triangles, made.meshes[m].triangles);
    EXPECT_EQ(later.meshes[m].triangles.size(), made.meshes[m].triangles.size());
  }
  EXPECT_EQ(source.bounds(1.0).min, glm::dvec3(-1.0, 0.0, -1.0));
  EXPECT_EQ(made.world_origin, glm::dvec3(0.0, 1.0, 0.0));
}

TEST(SceneSource, NamesTheBuiltInScenesThatThereAre) {
  try {
    const SceneSource source("builtin:teapot");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::usage);
    EXPECT_NE(std::string(error.what()).find("builtin:teapot"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("builtin:metaballs"), std::string::npos);
  }
}

}  // namespace
}  // namespace volgi
