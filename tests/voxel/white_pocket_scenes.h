#pragma once
// Rooms and bodies that light leaves, or not.
#include <string>
#include <vector>

#include "tests/support/volume_scenes.h"

namespace volgi::test {

struct PocketScene {
  std::string name;
  Scene scene;
  bool has_pocket;
};

inline Scene grey_room_with_a_body(glm::vec3 albedo, glm::vec3 room = glm::vec3(0.7f)) {
  Scene scene;
  add_box_inside(scene, add_material(scene, room), glm::vec3(0.0f), glm::vec3(1.0f));
  add_box_inside(scene, add_material(scene, albedo), {0.1f, 0.3f, -0.2f}, {0.3f, 0.2f, 0.25f});
  update_bounds(scene);
  return scene;
}

/// White walls and partitions that leave a gap at alternating ends; the last bay has a hole to the outside, or not.
inline Scene white_maze(bool open) {
  Scene scene;
  const int white = add_material(scene, glm::vec3(1.0f));
  add_quad(scene, white, {-1, -1, -1}, {2, 0, 0}, {0, 0, 2});
  add_quad(scene, white, {-1, 1, -1}, {2, 0, 0}, {0, 0, 2});
  add_quad(scene, white, {-1, -1, -1}, {2, 0, 0}, {0, 2, 0});
  add_quad(scene, white, {-1, -1, 1}, {2, 0, 0}, {0, 2, 0});
  add_quad(scene, white, {-1, -1, -1}, {0, 2, 0}, {0, 0, 2});
  add_quad(scene, white, {1, -1, -1}, {0, 2, 0}, {0, 0, open ? 1.6f : 2.0f});
  for (int i = 0; i < 5; ++i)
    add_quad(scene, white, {-0.7f + 0.35f * float(i), -1, i % 2 == 0 ? -1.0f : -0.7f}, {0, 2, 0}, {0, 0, 1.7f});
  update_bounds(scene);
  return scene;
}

inline std::vector<PocketScene> pocket_scenes() {
  std::vector<PocketScene> all;
  all.push_back({"white body in a grey room", grey_room_with_a_body(glm::vec3(1.0f)), true});
  all.push_back({"red body", grey_room_with_a_body({1.0f, 0.5f, 0.5f}), true});
  all.push_back({"nearly white body", grey_room_with_a_body(glm::vec3(0.99f)), false});
  all.push_back({"grey body in a white room", grey_room_with_a_body(glm::vec3(0.5f), glm::vec3(1.0f)), false});
  all.push_back({"white body in a white room", grey_room_with_a_body(glm::vec3(1.0f), glm::vec3(1.0f)), true});
  all.push_back({"open maze", white_maze(true), false});
  all.push_back({"sealed maze", white_maze(false), true});
  return all;
}

}  // namespace volgi::test
