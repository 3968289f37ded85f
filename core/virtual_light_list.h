#pragma once
#include <filesystem>
#include <glm/glm.hpp>
#include <vector>

#include "shaders/shared/virtual_light.shared.h"

namespace volgi {

/// Virtual lights as plain data: what `render --dump` writes and `reference --vpls` reads, so that another gather of
/// the same lights tells the error of visibility from that of sampling.
struct VirtualLightList {
  glm::dvec3 world_origin{0.0};  // Scene::world_origin of the positions
  std::vector<shared::VirtualLight> lights;
};

/// JSON: {"format": "volgi virtual lights 1", "world_origin": [x, y, z], "lights": [{"kind": "reflected" | "emitted" |
/// "negative" | "lattice", "source", "position", "normal", "flux", "area_m2"}]}; floats read back exactly.
/// @throws Error(cannot_write), as write_atomically does.
void write_virtual_lights(const std::filesystem::path& file, const VirtualLightList& list);
/// @throws Error(bad_input) naming the file, the light and the field.
VirtualLightList read_virtual_lights(const std::filesystem::path& file);

}  // namespace volgi
