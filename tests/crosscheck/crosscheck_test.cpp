// The GPU's volume against its CPU twin, stage by stage (docs/hard-cases.md, "twin"), for every scheme, on grids that
// are cubes and grids that are not. What counts as equal is in propagation/crosscheck.cpp.
#include "propagation/crosscheck.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "tests/support/gl_test.h"
#include "tests/support/paths.h"
#include "tests/support/volume_scenes.h"

namespace volgi::test {
namespace {

Scene file(const char* name) { return load_scene(source_dir() / "data" / (std::string(name) + ".glb")); }

/// 3 : 1 : 2, turned walls inside, a blended sheet, a pole thinner than a cell and a lamp: grids that are not cubes.
Scene long_room() {
  Scene scene;
  scene.name = "long_room";
  add_box_inside(scene, add_material(scene, {0.7f, 0.5f, 0.6f}), glm::vec3(0.0f), {3.0f, 1.0f, 2.0f});
  const int white = add_material(scene, glm::vec3(0.8f));
  add_square(scene, white, {0.4f, -0.3f, 0.2f}, {1.0f, 0.3f, 0.5f}, 0.6f);
  add_quad(scene, add_material(scene, glm::vec3(0.5f), {4.0f, 3.0f, 2.0f}), {-2.0f, 0.9f, -0.5f}, {1, 0, 0}, {0, 0, 1});
  Material glass = scene.materials[size_t(white)];
  glass.alpha_mode = AlphaMode::blend;
  glass.base_color_factor.a = 0.4f;
  scene.materials.push_back(glass);
  add_quad(scene, int(scene.materials.size()) - 1, {1.51f, -0.9f, -1.5f}, {0, 1.5f, 0}, {0, 0, 3.0f});
  for (int side = 0; side < 4; ++side) {  // 0.06 square
    const glm::vec3 n =
        side < 2 ? glm::vec3(side == 0 ? 0.03f : -0.03f, 0, 0) : glm::vec3(0, 0, side == 2 ? 0.03f : -0.03f);
    const glm::vec3 u = side < 2 ? glm::vec3(0, 0, 0.03f) : glm::vec3(0.03f, 0, 0);
    add_quad(scene, white, glm::vec3(-0.37f, -1.0f, 0.71f) + n - u, 2.0f * u, {0.0f, 2.0f, 0.0f});
  }
  scene.lights.push_back(
      spot_light({-1.0f, 0.7f, 0.3f}, {0.5f, -1.0f, -0.2f}, 30.0f, 40.0f, glm::vec3(5.0f, 4.0f, 3.0f)));
  return scene;
}

struct Case {
  const char* name;
  Scheme scheme;
  int sh_order = 1;
  std::optional<int> directions = std::nullopt;
  Ordinates ordinates = Ordinates::step;
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

class Crosscheck : public GlTest, public testing::WithParamInterface<Case> {
 protected:
  static VolumeOptions options(int grid_cells) {
    const Case& c = GetParam();
    VolumeOptions o;
    o.grid_cells = grid_cells;
    o.scheme.scheme = c.scheme;
    o.scheme.sh_order = c.sh_order;
    o.scheme.directions = c.directions;
    if (c.directions) o.scheme.ordinates = c.ordinates;
    return o;
  }
  static void expect_equal(const Scene& scene, const VolumeOptions& o, const std::vector<int>& passes) {
    for (const CrosscheckRow& r : crosscheck(scene, o, passes)) {
      EXPECT_TRUE(r.passed()) << scene.name << ", " << r.stage << ": " << r.maximum << " (limit " << r.limit
                              << ") at cell " << r.worst_cell.x << ',' << r.worst_cell.y << ',' << r.worst_cell.z;
      EXPECT_TRUE(r.compared > 0) << scene.name << ", " << r.stage;
      RecordProperty(scene.name + ": " + r.stage, std::to_string(r.maximum));
    }
  }
};

TEST_P(Crosscheck, Cornell) { expect_equal(file("cornell"), options(16), {1, 8, 64}); }
TEST_P(Crosscheck, Room) { expect_equal(file("room"), options(20), {1, 8}); }
TEST_P(Crosscheck, ThinWall) { expect_equal(file("thin_wall"), options(16), {1, 8}); }
TEST_P(Crosscheck, Emissive) { expect_equal(file("emissive"), options(16), {1, 8}); }
TEST_P(Crosscheck, LongRoom) { expect_equal(long_room(), options(24), {1, 8}); }

INSTANTIATE_TEST_SUITE_P(
    Schemes, Crosscheck,
    testing::Values(Case{"Step24", Scheme::ordinates, 1, 24}, Case{"Step48", Scheme::ordinates, 1, 48},
                    Case{"Characteristic80", Scheme::ordinates, 1, 80, Ordinates::characteristic},
                    Case{"Conservative", Scheme::conservative}, Case{"ConservativeOrder2", Scheme::conservative, 2},
                    Case{"Gaitatzes2010", Scheme::gaitatzes2010}, Case{"Gaitatzes2010Order2", Scheme::gaitatzes2010, 2},
                    Case{"Lpv2009", Scheme::lpv2009}, Case{"Lpv2009Order2", Scheme::lpv2009, 2}),
    [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace volgi::test
