#pragma once
#include "tests/support/volume_scenes.h"

namespace volgi::test {

/// Two rooms of 2 x 2 x 2 m that a wall of 15 cm parts, with a slit in it from floor to ceiling. In the first a lamp
/// shines away from it.
inline Scene rooms_with_slit(float width_m, float albedo = 0.7f) {
  Scene scene;
  const int grey = add_material(scene, glm::vec3(albedo));
  constexpr float wall = 0.075f, half = 1.0f;
  add_box_inside(scene, grey, glm::vec3(0.0f), {2.0f * half + wall, half, half});
  const float z[2] = {-half - 0.01f, 0.21f};  // begins
  const float end[2] = {0.21f - width_m, half + 0.01f};
  for (int i = 0; i < 2; ++i) {
    add_box(scene, grey, {0.0f, 0.0f, 0.5f * (z[i] + end[i])}, {wall, half + 0.01f, 0.5f * (end[i] - z[i])});
  }
  scene.lights.push_back(spot_light({-0.5f, 0.5f, -0.5f}, {-1.0f, 0.0f, 0.0f}, 20.0f, 40.0f, glm::vec3(10.0f)));
  return scene;
}

}  // namespace volgi::test
