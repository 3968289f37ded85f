// Sum of A * B0 over the sides against the flux that lit surfaces reflect, 16^3 ... 64^3, within 2 %: closed form on
// tilted planes, Embree shadow rays over the triangles of cornell and room.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "core/light.h"
#include "core/surface.h"
#include "core/visibility/embree_scene.h"
#include "tests/support/frame_picture.h"
#include "tests/support/gl_test.h"
#include "tests/support/paths.h"
#include "tests/support/volume_scenes.h"

namespace volgi::test {
namespace {

class InjectedFlux : public GlTest {
 protected:
  /// @param roofed  something lit looks out of the grid at its rim: what it reflects leaves the scene, and is counted.
  static void expect_flux(const Scene& scene, glm::vec3 flux, bool roofed = false) {
    for (int cells : {16, 32, 64}) {
      screen::FrameOptions options;
      options.recipe = "volume";
      options.size = {16, 16};
      options.of<VolumeOptions>().grid_cells = cells;
      options.bounces = 1;
      const Camera camera = framing_camera(scene.bounds_min, scene.bounds_max);
      const screen::FrameReport report = render(context(), scene, camera, options).report;
      if (!roofed) {
        EXPECT_EQ(report.of<screen::VolumeReport>().lost, glm::vec3(0.0f)) << cells;
      }
      const glm::vec3 counted = report.of<screen::VolumeReport>().injected + report.of<screen::VolumeReport>().lost;
      for (int band = 0; band < 3; ++band) {
        EXPECT_NEAR(counted[band], flux[band], 0.02f * flux[band]) << "grid " << cells << " band " << band;
      }
    }
  }

  /// Reflected flux by stratified points on every triangle and shadow rays: knows no map and no grid.
  static glm::vec3 traced_flux(const Scene& scene, double points_per_m2) {
    const EmbreeScene rays(scene);
    glm::dvec3 sum(0.0);
    for (const Mesh& mesh : scene.meshes) {
      for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
        sum += triangle_flux(scene, rays, mesh, t, points_per_m2);
    }
    return glm::vec3(sum);
  }

 private:
  static glm::dvec3 triangle_flux(const Scene& scene, const EmbreeScene& rays, const Mesh& mesh, std::uint32_t t,
                                  double density) {
    const glm::uvec3 c = mesh.triangles[t];
    const glm::vec3 cross =
        glm::cross(mesh.positions[c.y] - mesh.positions[c.x], mesh.positions[c.z] - mesh.positions[c.x]);
    const double area = 0.5 * glm::length(cross);
    const int n = std::max(4, int(std::sqrt(area * density)));
    glm::dvec3 sum(0.0);
    for (int i = 0; i < n * n; ++i) {
      // Equal cells of the unit square, folded onto the triangle.
      const int column = i % n, row = i / n;
      float u = (float(column) + 0.37f) / float(n), v = (float(row) + 0.61f) / float(n);
      if (u + v > 1.0f) {
        u = 1.0f - u;
        v = 1.0f - v;
      }
      const SurfacePoint p = surface_point(scene, mesh, t, u, v);
      for (const Light& light : scene.lights) {
        glm::vec3 to_light;
        const glm::vec3 e = shared::perpendicular_irradiance(to_shared(light), p.position, to_light);
        const float cosine = glm::dot(to_light, p.geometric_normal);
        if (e == glm::vec3(0.0f) || cosine == 0.0f) continue;
        const float distance = light.type == Light::Type::directional ? 1e6f : glm::length(light.position - p.position);
        const glm::vec3 start = p.position + (cosine > 0.0f ? 1e-4f : -1e-4f) * p.geometric_normal;
        if (rays.occluded(start, to_light, distance, 0)) continue;
        sum += glm::dvec3(e * std::abs(cosine) * p.albedo) * (area / double(n * n));
      }
    }
    return sum;
  }
};

TEST_F(InjectedFlux, TiltedPlaneUnderASun) {
  for (glm::vec3 normal : {glm::vec3(0, 1, 0), glm::vec3(1, 1, 0), glm::vec3(0.3f, 0.8f, -0.5f)}) {
    Scene scene;
    scene.name = "plane";
    add_square(scene, add_material(scene, glm::vec3(0.5f, 0.7f, 0.2f)), glm::vec3(0.0f), normal, 1.0f);
    const glm::vec3 direction = glm::normalize(glm::vec3(-0.2f, -1.0f, 0.3f));
    scene.lights.push_back(sun_light(direction, glm::vec3(3.0f)));
    const float cosine = std::abs(glm::dot(glm::normalize(normal), direction));
    expect_flux(scene, 4.0f * 3.0f * cosine * glm::vec3(0.5f, 0.7f, 0.2f));
  }
}

TEST_F(InjectedFlux, TiltedPlaneUnderASpot) {
  // A cone of 20 degrees about the normal, all of it on the plane: flux = I * solid angle, softened over the last
  // degree.
  Scene scene;
  scene.name = "plane";
  const glm::vec3 normal = glm::normalize(glm::vec3(0.5f, 0.7f, 0.2f));
  add_square(scene, add_material(scene, glm::vec3(0.6f)), glm::vec3(0.0f), normal, 1.0f);
  scene.lights.push_back(spot_light(2.0f * normal, -normal, 19.0f, 20.0f, glm::vec3(5.0f)));
  const double outer = std::cos(glm::radians(20.0)), inner = std::cos(glm::radians(19.0));
  const double solid_angle = 2.0 * M_PI * ((1.0 - inner) + (inner - outer) / 3.0);  // falloff is squared in the cosine
  expect_flux(scene, glm::vec3(float(5.0 * solid_angle * 0.6)));
}

TEST_F(InjectedFlux, CornellAgainstShadowRays) {
  const Scene scene = load_scene(source_dir() / "data/cornell.glb");
  expect_flux(scene, traced_flux(scene, 40000.0));
}

TEST_F(InjectedFlux, RoomAgainstShadowRays) {
  const Scene scene = load_scene(source_dir() / "data/room.glb");
  expect_flux(scene, traced_flux(scene, 6000.0), true);
}

}  // namespace
}  // namespace volgi::test
