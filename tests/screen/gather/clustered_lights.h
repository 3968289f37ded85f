#pragma once
// Lights over a floor, their clusters and what these see, for gathers of clustered lights.
#include <memory>
#include <random>
#include <vector>

#include "screen/visibility/area_maps/area_light_shadow.h"
#include "tests/screen/gathered.h"

namespace volgi::test {

/// Lights in a layer over the floor, facing down and to the sides.
inline std::vector<VirtualLight> lights_above(int count, float low, float high, int kind, unsigned seed) {
  std::mt19937 random(seed);
  const auto uniform = [&] { return float(random()) / 4294967296.0f; };
  std::vector<VirtualLight> lights;
  for (int i = 0; i < count; ++i) {
    const glm::vec3 position(4.0f * uniform() - 2.0f, glm::mix(low, high, uniform()), 4.0f * uniform() - 2.0f);
    const glm::vec3 normal(uniform() - 0.5f, -1.0f, uniform() - 0.5f);
    lights.push_back(light_at(position, normal, {uniform(), uniform(), uniform()}, 0.05f, kind));
  }
  return lights;
}

inline void add_floor(Scene& scene) {
  add_quad(scene, add_material(scene, {0.8f, 0.5f, 0.2f}), {-2, 0, -2}, {0, 0, 4}, {4, 0, 0});
}

inline Scene open_floor() {
  Scene scene;
  add_floor(scene);
  update_bounds(scene);
  return scene;
}

/// A box stands on the floor, and a plate floats over it.
inline Scene floor_with_edges() {
  Scene scene;
  add_floor(scene);
  add_box(scene, 0, {-0.8f, 0.0f, 0.0f}, {0.8f, 0.9f, 0.8f}, 0.4f);
  add_quad(scene, add_material(scene, {0.6f, 0.6f, 0.6f}), {0.3f, 1.2f, -1.0f}, {0, 0, 1.6f}, {1.2f, 0, 0});
  update_bounds(scene);
  return scene;
}

/// What one scene and its lights look like, by any gather.
struct ClusteredLights {
  ClusteredLights(const gl::Context& context, const Scene& scene, glm::ivec2 size,
                  const std::vector<VirtualLight>& reflected, const std::vector<VirtualLight>& emitted = {})
      : seen(context, scene,
             look_at_camera({0.3f, 3.2f, 2.6f}, {0.0f, 0.2f, 0.0f}, 0.9f, scene.bounds_min, scene.bounds_max), size),
        buffers(scene),
        list(list_of(reflected, emitted)),
        area_lights({.count = 30}),  // more of them have planes that some of their lights shine behind
        maps(64, area_lights.count()),
        shadow(screen::AreaLightShadow::make(screen::AreaLightShadow::Method::single,
                                             screen::AreaLightShadow::Filter::map, 64, area_lights.count())) {
    area_lights.run(list.buffer, list.count(), seen.diagonal_m, seen.timer);
    maps.run(buffers, area_lights, seen.timer);
    shadow->run(maps, seen.timer);
  }

  Seen seen;
  gl::SceneBuffers buffers;
  VirtualLightListGl list;
  screen::VirtualAreaLights area_lights;
  screen::ParaboloidDepthMaps maps;
  std::unique_ptr<screen::AreaLightShadow> shadow;
};

}  // namespace volgi::test
