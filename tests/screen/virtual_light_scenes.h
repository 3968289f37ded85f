#pragma once
// A room of six colours, one light of each kind, and the virtual lights that come of them.
#include <algorithm>
#include <vector>

#include "screen/lights/rsm/virtual_lights.h"
#include "tests/screen/screen_scene.h"

namespace volgi::test {

using screen::VirtualLightOptions;
using shared::VirtualLight;
using Sampling = VirtualLightOptions::Sampling;
inline constexpr Sampling kSamplings[] = {Sampling::halton, Sampling::flux};
inline constexpr screen::ReflectiveShadowMap::Resolution kResolution{200, 100, 200};  // no powers of two or four

/// A scene, its maps and its virtual lights, for one frame after another.
class Frames {
 public:
  Frames(const gl::Context& context, const Scene& scene, const VirtualLightOptions& options)
      : scene_(scene),
        timer_(context.software(), false),
        buffers_(scene),
        maps_(kResolution),
        lights_(scene, options) {}

  const screen::ReflectiveShadowMap& maps() const { return maps_; }
  const screen::VirtualLights& run() {
    maps_.run(buffers_, scene_, timer_);
    lights_.run(maps_, nullptr, timer_);
    return lights_;
  }

 private:
  const Scene& scene_;
  gl::PassTimer timer_;
  gl::SceneBuffers buffers_;
  screen::ReflectiveShadowMap maps_;
  screen::VirtualLights lights_;
};

inline std::vector<VirtualLight> lights_of(const gl::Context& context, const Scene& scene,
                                           VirtualLightOptions options) {
  return Frames(context, scene, options).run().download().lights;
}

inline glm::dvec3 sum_of_flux(const std::vector<VirtualLight>& lights) {
  glm::dvec3 sum(0.0);
  for (const VirtualLight& l : lights) sum += glm::dvec3(l.flux);
  return sum;
}

inline double sum_of_area(const std::vector<VirtualLight>& lights) {
  double sum = 0.0;
  for (const VirtualLight& l : lights) sum += double(l.area_m2);
  return sum;
}

inline constexpr glm::vec3 kHalf(1.0f, 0.75f, 1.5f);
inline const glm::vec3 kLamp(0.3f, -0.2f, 0.7f);

/// A closed box of 2 x 1.5 x 3 m around the origin, every wall of another colour.
inline Scene colourful_room() {
  Scene scene;
  for (int face = 0; face < 6; ++face) {
    const int axis = face / 2;
    const int b = (axis + 1) % 3;
    const int c = (axis + 2) % 3;
    glm::vec3 albedo(0.2f, 0.5f, 0.8f);
    albedo = glm::vec3(albedo[axis], albedo[b], albedo[c]) * (face % 2 == 0 ? 1.0f : 0.6f);
    glm::vec3 corner = -kHalf, u(0.0f), v(0.0f);
    corner[axis] = face % 2 == 0 ? kHalf[axis] : -kHalf[axis];
    u[b] = 2.0f * kHalf[b];
    v[c] = 2.0f * kHalf[c];
    add_quad(scene, add_material(scene, albedo), corner, u, v);
  }
  update_bounds(scene);
  return scene;
}

inline double distance_to_wall(glm::vec3 p) {
  const glm::vec3 d = kHalf - glm::abs(p);
  return double(std::min({d.x, d.y, d.z}));
}

inline std::vector<Light> one_of_each() {
  std::vector<Light> lights = {spot_light(kLamp, {0.2f, -1.0f, -0.5f}, 12, 30, 2.5f),
                               spot_light(kLamp, {0.2f, 0.3f, -0.5f}, 40, 100, 2.5f), point_light(kLamp, 2.5f),
                               sun_light({0.4f, -1.0f, 0.3f}, 3.0f)};
  lights[2].range_m = 2.5f;
  return lights;
}

}  // namespace volgi::test
