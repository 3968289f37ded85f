// Tilted surfaces where a furnace cannot tell a wrong rule from a right one (docs/hard-cases.md, "tilt"): a sphere's
// cavity, whose indirect irradiance is the same everywhere whatever the source, and black walls, which return nothing.
#include <gtest/gtest.h>

#include <cmath>

#include "core/visibility/light_flux.h"
#include "propagation/bounces_cpu.h"
#include "propagation/bounces_gl.h"
#include "propagation/side_irradiance_gl.h"
#include "propagation/transport_conservative_gl.h"
#include "propagation/transport_ordinates_gl.h"
#include "screen/bounces/volume/inject_reflective_shadow_map.h"
#include "screen/frame/frame.h"
#include "tests/hardcases/frame_case.h"
#include "tests/support/frame_picture.h"
#include "tests/support/gl_test.h"
#include "tests/support/volume_scenes.h"
#include "tests/support/voxels.h"
#include "voxel/emitter_pieces.h"
#include "voxel/voxelize_cpu.h"

namespace volgi::test {
namespace {

struct Solved {
  std::vector<Side> sides;
  std::vector<glm::vec4> received_direct, received_indirect, direct, indirect;
};

class Cavity : public GlTest {
 protected:
  static SchemeOptions scheme_options(Scheme scheme) {
    SchemeOptions options;
    options.scheme = scheme;
    options.coarse_start = false;
    if (scheme == Scheme::ordinates) {
      options.directions = 48;
      options.ordinates = Ordinates::step;
    }
    return options;
  }

  static Solved solve(const Scene& scene, const Grid& grid, Scheme scheme, float largest_albedo) {
    return tested_backend() == screen::Backend::cpu ? solve_cpu(scene, grid, scheme, largest_albedo)
                                                    : solve_gpu(scene, grid, scheme, largest_albedo);
  }

  /// The volume as propagation/volume_cpu.cpp runs it, on a grid of the test's own.
  static Solved solve_cpu(const Scene& scene, const Grid& grid, Scheme scheme, float largest_albedo) {
    const VoxelGrid voxels = voxelize_cpu(scene, grid);
    const std::vector<FluxSample> pieces = emitter_pieces(scene, grid);
    SideFlux flux;
    flux.emitted.assign(voxels.side_count(), glm::vec4(0.0f));
    flux.punctual = flux.emitted;
    deposit(voxels, pieces, flux.emitted, flux.lost);
    if (!scene.lights.empty()) deposit(voxels, light_flux(EmbreeScene(scene), 512), flux.punctual, flux.lost);
    BouncesCpu bounces(make_transport(voxels, scheme_options(scheme)));
    BounceRules rules;
    rules.largest_albedo = largest_albedo;
    bounces.run(voxels, flux, !pieces.empty(), rules);
    const SideIrradiance irradiance = side_irradiance(voxels, flux, bounces);
    return {voxels.sides(), bounces.received_direct(), bounces.received_indirect(), irradiance.direct,
            irradiance.indirect};
  }

  /// The volume's part of a frame, as screen/bounces/volume/volume_on_gpu.cpp runs it.
  static Solved solve_gpu(const Scene& scene, const Grid& grid, Scheme scheme, float largest_albedo) {
    gl::PassTimer timer(context().software(), false);
    const gl::SceneBuffers buffers(scene);
    screen::ReflectiveShadowMap maps;
    maps.run(buffers, scene, timer);
    SlicedVoxelization voxelization(grid);
    voxelization.run(buffers, timer);
    const VoxelGridGl& voxels = voxelization.voxels();
    const std::vector<FluxSample> pieces = emitter_pieces(scene, grid);
    SideFluxGl flux;
    flux.begin(voxels);
    flux.inject_emitters(voxels, pieces, timer);
    screen::InjectReflectiveShadowMap().run(voxels, maps, scene, flux, timer);
    std::unique_ptr<TransportGl> transport = std::make_unique<OrdinatesTransportGl>(grid, scheme_options(scheme));
    if (scheme == Scheme::conservative) transport = std::make_unique<ConservativeTransportGl>(grid);
    BouncesGl bounces(std::move(transport));
    BounceRules rules;
    rules.largest_albedo = largest_albedo;
    bounces.run(voxels, flux, !pieces.empty(), rules, timer);
    SideIrradianceGl irradiance;
    irradiance.run(voxels, flux, bounces, timer);
    Solved s{voxels.download_sides(), {}, {}, {}, {}};
    const size_t n = s.sides.size();
    s.received_direct = bounces.received_direct().download<glm::vec4>(n);
    s.received_indirect = bounces.received_indirect().download<glm::vec4>(n);
    s.direct = irradiance.direct().download<glm::vec4>(n);
    s.indirect = irradiance.indirect().download<glm::vec4>(n);
    return s;
  }

  /// A spot in the middle of a sphere lights a twelfth of it: mean E of all reflected light over the exact rho Phi /
  /// ((1-rho) area).
  static double sphere_ratio(float albedo, Scheme scheme, int cells, glm::vec3 centre = glm::vec3(0.0f)) {
    Scene scene;
    add_sphere_inside(scene, add_material(scene, glm::vec3(albedo)), centre, 0.9f, 24);
    scene.lights.push_back(
        spot_light(centre + glm::vec3(0.01f, 0.02f, 0.0f), {1.0f, -0.6f, 0.4f}, 32.0f, 33.0f, glm::vec3(2.0f)));
    const Solved s = solve(scene, unit_grid(cells), scheme, albedo);
    double sum = 0.0, areas = 0.0;
    for (size_t i = 0; i < s.sides.size(); ++i) {
      const glm::vec3 c = glm::vec3(shared::cell_coord(unit_grid(cells), s.sides[i].cell)) + 0.5f -
                          shared::cell_from_world(unit_grid(cells), centre);
      if (glm::dot(s.sides[i].normal, c) > 0.0f) continue;  // seen from outside
      sum += double(s.sides[i].area_m2 * s.indirect[i].x);
      areas += double(s.sides[i].area_m2);
    }
    const double outer = std::cos(glm::radians(33.0)), inner = std::cos(glm::radians(32.0));
    const double flux = 2.0 * 2.0 * glm::pi<double>() * ((1.0 - inner) + (inner - outer) / 3.0);
    const double exact = double(albedo) * flux / ((1.0 - double(albedo)) * area(scene));
    return sum / areas / exact;
  }
};

// A turned furnace as furnace_test.cpp has it, but by all sides of its walls: pixels see the middles of some, which
// pulses of `conservative` light too much. In software the GPU has time for fewer cells.
TEST_F(Cavity, TurnedFurnaceConservative) {
  const int cells = tested_backend() == screen::Backend::gpu && context().software() ? 12 : 32;
  const glm::mat3 about_y = rotation({0, 1, 0}, 45.0f);
  const glm::mat3 all_ways = rotation({1, 0, 0}, 30.0f) * rotation({0, 1, 0}, 20.0f) * rotation({0, 0, 1}, 10.0f);
  for (float albedo : {0.5f, 0.8f}) {
    for (const glm::mat3& turn : {about_y, all_ways}) {
      Scene scene;
      add_box_inside(scene, add_material(scene, glm::vec3(albedo), glm::vec3(1.0f)), glm::vec3(0.0f), glm::vec3(1.0f),
                     turn);
      const Grid grid = make_grid(scene, cells);
      const Solved s = solve(scene, grid, Scheme::conservative, albedo);
      double sum = 0.0, areas = 0.0;
      for (size_t i = 0; i < s.sides.size(); ++i) {
        const glm::vec3 c = shared::world_from_cell(grid, glm::vec3(shared::cell_coord(grid, s.sides[i].cell)) + 0.5f);
        if (glm::dot(s.sides[i].normal, c) > 0.0f) continue;  // seen from outside
        sum += double(s.sides[i].area_m2 * (s.direct[i].x + s.indirect[i].x));
        areas += double(s.sides[i].area_m2);
      }
      const double radiance = 1.0 + double(albedo) * sum / areas / glm::pi<double>();
      expect_of_frame("tilt",
                      fmt::format("furnace turned by {}, conservative, albedo {}, all sides",
                                  turn == about_y ? "45° about Y" : "(30°, 20°, 10°)", albedo),
                      off_percent(radiance * double(1.0f - albedo)), 3.0);
    }
  }
}

TEST_F(Cavity, SphereOrdinates) {
  for (float albedo : {0.3f, 0.7f}) {
    const double ratio = sphere_ratio(albedo, Scheme::ordinates, 24);
    expect_of_frame("tilt", fmt::format("spherical cavity, ordinates, albedo {}", albedo), off_percent(ratio), 3.0);
  }
}

// Nine samples of area a face see a sphere of 14 cells differently from place to place (rms 2.5 % at albedo 0.3): the
// mean over places counts.
TEST_F(Cavity, SphereConservative) {
  for (float albedo : {0.3f, 0.7f}) {
    double sum = 0.0;
    for (glm::vec3 centre : {glm::vec3(0.0f), glm::vec3(0.03f, -0.02f, 0.05f), glm::vec3(-0.05f, 0.04f, 0.02f),
                             glm::vec3(0.04f, 0.05f, -0.03f)}) {
      const double ratio = sphere_ratio(albedo, Scheme::conservative, 16, centre);
      expect_of_frame("tilt", fmt::format("spherical cavity, conservative, albedo {}, at {}", albedo, centre.x),
                      off_percent(ratio), 3.0);
      sum += ratio;
    }
    EXPECT_NEAR(sum / 4.0, 1.0, 0.03) << "albedo " << albedo;
  }
}

// Black walls that glow with L_e, and black between them: a wall through the whole box, and a plate. Nothing comes back
// from anywhere, and both see L_e from all directions, so that E = pi L_e. Too much is measured: of what a black
// staircase sends back to its own steps, nothing, the schemes let it take a part from beyond; a plate draws light
// around its rim as well.
struct BlackCase {
  Scheme scheme;
  int cells;
  float half_edge;
  double max_excess;  // a tenth above what is measured; 0.03 is asked for (docs/results/where-we-miss.md)
};

void PrintTo(const BlackCase& c, std::ostream* out) { *out << c.cells << " cells, half edge " << c.half_edge; }

class BlackSurface : public Cavity, public testing::WithParamInterface<BlackCase> {};

TEST_P(BlackSurface, ReturnsNothing) {
  const BlackCase& c = GetParam();
  for (glm::vec3 normal : {glm::vec3(1, 1, 0), glm::vec3(1, 2, -1)}) {
    Scene scene;
    add_box_inside(scene, add_material(scene, glm::vec3(0.0f), glm::vec3(1.0f)), glm::vec3(0.0f), glm::vec3(1.0f));
    add_square(scene, add_material(scene, glm::vec3(0.0f)), glm::vec3(0.05f, -0.04f, 0.03f), normal, c.half_edge);
    const Solved s = solve(scene, unit_grid(c.cells), c.scheme, 0.0f);
    double irradiance = 0.0, black_area = 0.0, sent = 0.0, received = 0.0;
    for (size_t i = 0; i < s.sides.size(); ++i) {
      ASSERT_EQ(glm::vec3(s.received_indirect[i]), glm::vec3(0.0f));
      sent += double(s.sides[i].radiosity.x * s.sides[i].face_m2);
      received += double(s.received_direct[i].x);
      if (std::abs(glm::dot(s.sides[i].normal, glm::normalize(normal))) < 0.99f) continue;
      irradiance += double(s.sides[i].area_m2 * s.direct[i].x);
      black_area += double(s.sides[i].area_m2);
    }
    EXPECT_NEAR(received / sent, 1.0,
                0.025);  // emitters count by area, their sides by faces: they part where walls meet
    const double ratio = irradiance / black_area / glm::pi<double>();
    EXPECT_GT(ratio, 0.97);
    expect_of_frame(
        "tilt",
        fmt::format("black {} across {:g},{:g},{:g}, {}, too much", c.half_edge > 1.0f ? "wall" : "plate", normal.x,
                    normal.y, normal.z, c.scheme == Scheme::ordinates ? "ordinates" : "conservative"),
        std::max(0.0, 100.0 * (ratio - 1.0)), 100.0 * c.max_excess, 3.0,
        "of what a black staircase sends back to its own steps, nothing, a part is taken from beyond");
  }
}

INSTANTIATE_TEST_SUITE_P(Schemes, BlackSurface,
                         testing::Values(BlackCase{Scheme::ordinates, 24, 4.0f, 0.078},
                                         BlackCase{Scheme::ordinates, 24, 0.5f, 0.115},
                                         BlackCase{Scheme::conservative, 16, 4.0f, 0.14},
                                         BlackCase{Scheme::conservative, 16, 0.5f, 0.75}),
                         [](const auto& test) {
                           return std::string(test.param.scheme == Scheme::ordinates ? "Ordinates" : "Conservative") +
                                  (test.param.half_edge > 1.0f ? "Wall" : "Plate");
                         });

}  // namespace
}  // namespace volgi::test
