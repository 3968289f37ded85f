// Scenes that lack something, or have too much of it: the same image, a black one, or a clear error.
#include <gtest/gtest.h>

#include <filesystem>

#include "core/error.h"
#include "reference/path_tracer.h"
#include "tests/support/frame_picture.h"
#include "tests/support/gl_test.h"
#include "tests/support/invariance.h"
#include "tests/support/paths.h"
#include "tests/support/volume_scenes.h"

namespace volgi::test {
namespace {

const std::filesystem::path kData = source_dir() / "data";

class Degenerate : public GlTest {
 protected:
  static screen::FrameOptions options() {
    screen::FrameOptions o;
    o.recipe = "volume";
    o.size = {64, 64};
    o.of<VolumeOptions>().grid_cells = 12;
    return o;
  }
  static Image framed(const Scene& scene, const screen::FrameOptions& o = options()) {
    return render(context(), scene, framing_camera(scene.bounds_min, scene.bounds_max), o).image;
  }
};

TEST_F(Degenerate, NothingAtAll) { EXPECT_EQ(mean_light(framed(Scene{})), 0.0); }

TEST_F(Degenerate, LightsWithoutTriangles) {
  Scene scene;
  scene.lights.push_back(point_light(glm::vec3(1.0f), glm::vec3(5.0f)));
  scene.lights.push_back(sun_light({0.0f, -1.0f, 0.0f}, glm::vec3(5.0f)));
  EXPECT_EQ(mean_light(framed(scene)), 0.0);
}

TEST_F(Degenerate, NoLights) {
  Scene scene = load_scene(kData / "cornell.glb");
  scene.lights.clear();
  EXPECT_EQ(mean_light(render(context(), scene, scene.cameras.at(0), options()).image), 0.0);
}

TEST_F(Degenerate, OneTriangle) {
  for (Scheme scheme : {Scheme::ordinates, Scheme::conservative}) {
    Scene scene;
    Mesh& mesh = add_quad(scene, add_material(scene, glm::vec3(0.8f)), {-1, 0, 0}, {2, 0, 0}, {0, 1, 1});
    mesh.triangles.resize(1);
    scene.lights.push_back(point_light({0.0f, 0.5f, 2.0f}, glm::vec3(3.0f)));
    screen::FrameOptions o = options();
    o.of<VolumeOptions>().scheme.scheme = scheme;
    EXPECT_GT(mean_light(framed(scene, o)), 0.0);
    o.light = screen::LightPart::indirect;
    EXPECT_LT(mean_light(framed(scene, o)), 1e-3);  // a plane does not light itself
  }
}

// Flat scenes have one layer of cells.
TEST_F(Degenerate, GridsOneCellThick) {
  for (int axis = 0; axis < 3; ++axis) EXPECT_GT(mean_light(framed(square_across(axis))), 0.0);
  Scene rod;  // 100 : 1 : 1
  add_box_inside(rod, add_material(rod, glm::vec3(0.7f)), glm::vec3(0.0f), {10.0f, 0.1f, 0.1f});
  rod.lights.push_back(point_light(glm::vec3(0.0f), glm::vec3(0.1f)));
  mean_light(framed(rod));
}

TEST_F(Degenerate, TrianglesWithoutArea) {
  Scene scene = load_scene(kData / "cornell.glb");
  const Image ref = render(context(), scene, scene.cameras.at(0), options()).image;
  for (Mesh& mesh : scene.meshes) {
    const glm::uvec3 t = mesh.triangles.at(0);
    mesh.triangles.push_back({t.x, t.x, t.y});
    mesh.triangles.push_back({t.z, t.z, t.z});
  }
  EXPECT_NEAR(mean_light(render(context(), scene, scene.cameras.at(0), options()).image) / mean_light(ref), 1.0, 1e-3);
}

// Every triangle twice. Sides then count its area twice and absorb too much: 0.797 of the light is left, where it
// should be all.
TEST_F(Degenerate, Duplicates) {
  Scene scene = load_scene(kData / "cornell.glb");
  const Image ref = render(context(), scene, scene.cameras.at(0), options()).image;
  for (Mesh& mesh : scene.meshes) {
    const std::vector<glm::uvec3> once = mesh.triangles;
    mesh.triangles.insert(mesh.triangles.end(), once.begin(), once.end());
  }
  EXPECT_EQ(drop_duplicate_triangles(scene), 30u);  // as the loader does
  EXPECT_TRUE(render(context(), scene, scene.cameras.at(0), options()).image.pixels == ref.pixels);
}

// A sheet just in front of a wall, as carpets and pictures are, takes the wall's place.
TEST_F(Degenerate, SheetOnAWall) {
  const auto picture = [](bool sheet) {
    Scene scene;
    const int grey = add_material(scene, glm::vec3(0.6f));
    add_box_inside(scene, grey, glm::vec3(0.0f), glm::vec3(1.0f));
    if (sheet) add_quad(scene, grey, {-1.0f, -0.985f, -1.0f}, {0, 0, 2}, {2, 0, 0});
    scene.lights.push_back(point_light({0.0f, 0.6f, 0.0f}, glm::vec3(3.0f)));
    const Camera camera =
        look_at_camera({0.6f, 0.5f, 0.9f}, {-0.3f, -0.4f, -0.6f}, 1.2f, scene.bounds_min, scene.bounds_max);
    screen::FrameOptions o = options();
    o.light = screen::LightPart::indirect;
    return mean_light(render(context(), scene, camera, o).image);
  };
  EXPECT_NEAR(picture(true) / picture(false), 1.0, 0.03);
}

TEST_F(Degenerate, UnknownDirectionsAndGrids) {
  const Scene scene = load_scene(kData / "cornell.glb");
  screen::FrameOptions o = options();
  o.of<VolumeOptions>().scheme.directions = 10;
  EXPECT_THROW(screen::Frame(scene, o), Error);
  o = options();
  o.of<VolumeOptions>().grid_cells = 0;
  EXPECT_THROW(screen::Frame(scene, o), Error);
}

// Emissive surfaces light the scene through the volume, first arrival and all: the hardest thing to ask of it.
TEST_F(Degenerate, EmissiveSceneAgainstPaths) {
  const Scene scene = load_scene(kData / "emissive.glb");
  PathTracerOptions tracer;
  tracer.size = {64, 64};
  tracer.samples_per_pixel = 64;
  const double exact = mean_light(path_trace(scene, scene.cameras.at(0), tracer).color);
  screen::FrameOptions o = options();
  o.of<VolumeOptions>().grid_cells = 24;
  const double energy = mean_light(render(context(), scene, scene.cameras.at(0), o).image) / exact;
  EXPECT_NEAR(energy, 1.0, 0.25);
  RecordProperty("energy", std::to_string(energy));
  for (screen::LightPart part : {screen::LightPart::direct, screen::LightPart::indirect}) {
    o.light = part;
    EXPECT_GT(mean_light(render(context(), scene, scene.cameras.at(0), o).image), 0.0);
  }
}

}  // namespace
}  // namespace volgi::test
