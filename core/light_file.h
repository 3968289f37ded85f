#pragma once
#include <filesystem>
#include <map>
#include <vector>

#include "core/scene.h"

namespace volgi {

/// What somebody has changed of a scene's light, as a file: its punctual lights, all of them, in place of the scene's,
/// and what materials emit.
struct LightFile {
  std::vector<Light> lights;                   // in the centred frame of the scene that they are for
  std::map<int, glm::vec3> emissive_radiance;  // Material::emissive_radiance by the number of the material
};

/// JSON, positions in the file's world frame, written atomically.
/// @throws Error(cannot_write).
void write_light_file(const std::filesystem::path& path, const LightFile& light, const glm::dvec3& world_origin);
/// @throws Error(bad_input) naming file, light and field: no such format, a missing or negative number, a direction
///   without length.
LightFile read_light_file(const std::filesystem::path& path, const glm::dvec3& world_origin);
/// @throws Error(bad_input) naming a material that the scene does not have.
void apply_light_file(const LightFile& light, const std::filesystem::path& path, Scene& scene);

}  // namespace volgi
