#include "core/light_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/atomic_file.h"
#include "core/error.h"

namespace volgi {

namespace {

using nlohmann::json;

constexpr const char* FORMAT = "volgi_lights";
constexpr int VERSION = 1;
constexpr std::array TYPES = {"point", "spot", "directional"};  // Light::Type

template <class V>
json to_json(const V& v) {
  return {v.x, v.y, v.z};
}

json to_json(const Light& light, const glm::dvec3& world_origin) {
  return {{"name", light.name},
          {"type", TYPES[size_t(light.type)]},
          {"position", to_json(glm::dvec3(light.position) + world_origin)},
          {"direction", to_json(light.direction)},
          {"intensity", to_json(light.intensity)},
          {"inner_cone_rad", light.inner_cone_rad},
          {"outer_cone_rad", light.outer_cone_rad},
          {"range_m", light.range_m}};
}

/// Reads one object, and says where it is when it does not like it.
class Fields {
 public:
  Fields(const std::filesystem::path& file, std::string where, const json& object)
      : file_(file), where_(std::move(where)), object_(object) {
    if (!object.is_object()) refuse("needs to be an object");
  }
  [[noreturn]] void refuse(const std::string& what) const {
    throw Error(ExitCode::bad_input, fmt::format("{}: {}: {}", file_.string(), where_, what));
  }
  double number(const char* name, double least) const {
    const json& value = at(name);
    if (!value.is_number() || !std::isfinite(value.get<double>()) || value.get<double>() < least)
      refuse(fmt::format("{} needs to be a number{}", name, least == 0.0 ? ", not negative" : ""));
    return value.get<double>();
  }
  glm::dvec3 vector(const char* name, double least) const {
    const json& value = at(name);
    const auto fits = [&](const json& v) {
      return v.is_number() && std::isfinite(v.get<double>()) && v.get<double>() >= least;
    };
    if (!value.is_array() || value.size() != 3 || !std::all_of(value.begin(), value.end(), fits))
      refuse(fmt::format("{} needs three numbers{}", name, least == 0.0 ? ", none negative" : ""));
    return {value[0].get<double>(), value[1].get<double>(), value[2].get<double>()};
  }
  std::string text(const char* name) const {
    const json& value = at(name);
    if (!value.is_string()) refuse(fmt::format("{} needs to be a text", name));
    return value.get<std::string>();
  }

 private:
  const json& at(const char* name) const {
    const auto found = object_.find(name);
    if (found == object_.end()) refuse(fmt::format("{} is missing", name));
    return *found;
  }
  const std::filesystem::path& file_;
  std::string where_;
  const json& object_;
};

constexpr double ANY = -std::numeric_limits<double>::infinity();

Light light_of(const Fields& fields, const glm::dvec3& world_origin) {
  Light light;
  light.name = fields.text("name");
  const std::string type = fields.text("type");
  const auto* const found = std::find(TYPES.begin(), TYPES.end(), type);
  if (found == TYPES.end()) fields.refuse("type needs to be point, spot or directional");
  light.type = Light::Type(found - TYPES.begin());
  light.position = glm::vec3(fields.vector("position", ANY) - world_origin);
  const glm::dvec3 direction = fields.vector("direction", ANY);
  if (!(glm::length(direction) > 0.0)) fields.refuse("direction has no length");
  light.direction = glm::vec3(glm::normalize(direction));
  light.intensity = glm::vec3(fields.vector("intensity", 0.0));
  light.inner_cone_rad = float(fields.number("inner_cone_rad", 0.0));
  light.outer_cone_rad = float(fields.number("outer_cone_rad", 0.0));
  light.range_m = float(fields.number("range_m", 0.0));
  return light;
}

json parsed(const std::filesystem::path& path) {
  std::ifstream in(path);
  if (!in) throw Error(ExitCode::bad_input, path.string() + ": there is no such file");
  json root = json::parse(in, nullptr, false);
  if (root.is_discarded() || !root.is_object() || !root.contains(FORMAT) || root[FORMAT] != VERSION)
    throw Error(ExitCode::bad_input,
                fmt::format("{}: not a file of lights (\"{}\": {})", path.string(), FORMAT, VERSION));
  for (const char* list : {"lights", "emission"}) {
    if (root.contains(list) && !root[list].is_array())
      throw Error(ExitCode::bad_input, fmt::format("{}: {} needs to be a list", path.string(), list));
  }
  return root;
}

}  // namespace

void write_light_file(const std::filesystem::path& path, const LightFile& light, const glm::dvec3& world_origin) {
  json root = {{FORMAT, VERSION}, {"lights", json::array()}, {"emission", json::array()}};
  for (const Light& l : light.lights) root["lights"].push_back(to_json(l, world_origin));
  for (const auto& [material, radiance] : light.emissive_radiance)
    root["emission"].push_back({{"material", material}, {"radiance", to_json(radiance)}});
  write_text_atomically(path, root.dump(1) + '\n');
}

LightFile read_light_file(const std::filesystem::path& path, const glm::dvec3& world_origin) {
  const json root = parsed(path);
  LightFile light;
  const json none = json::array();
  const json& lights = root.contains("lights") ? root["lights"] : none;
  const json& emission = root.contains("emission") ? root["emission"] : none;
  for (size_t k = 0; k < lights.size(); ++k)
    light.lights.push_back(light_of(Fields(path, fmt::format("light {}", k), lights[k]), world_origin));
  for (size_t k = 0; k < emission.size(); ++k) {
    const Fields fields(path, fmt::format("emission {}", k), emission[k]);
    light.emissive_radiance[int(fields.number("material", 0.0))] = glm::vec3(fields.vector("radiance", 0.0));
  }
  return light;
}

void apply_light_file(const LightFile& light, const std::filesystem::path& path, Scene& scene) {
  scene.lights = light.lights;
  for (const auto& [material, radiance] : light.emissive_radiance) {
    if (size_t(material) >= scene.materials.size())
      throw Error(ExitCode::bad_input, fmt::format("{}: material {}: {} has {}", path.string(), material, scene.name,
                                                   scene.materials.size()));
    scene.materials[size_t(material)].emissive_radiance = radiance;
  }
}

}  // namespace volgi
