#include "apps/volgi/scene_options.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "apps/volgi/parse_number.h"
#include "core/error.h"
#include "core/log.h"
#include "core/sky.h"
#include "core/visibility/room_camera.h"

namespace volgi::app {
namespace {

constexpr int largest_edge = 16384;

std::vector<double> parse_point(const std::string& option, std::string_view text) {
  std::vector<double> point = parse_numbers(text);
  if (point.size() != 3) throw CLI::ValidationError(option, "takes three numbers X,Y,Z in metres, such as 1,2.5,-3");
  return point;
}

std::string check_finite(const std::string& text) {
  return parse_number<double>(text) ? std::string() : fmt::format("'{}' is not a finite number", text);
}

glm::vec3 centred(const std::vector<double>& world, const Scene& scene) {
  return glm::vec3(glm::dvec3(world[0], world[1], world[2]) - scene.world_origin);
}

}  // namespace

void SceneOptions::add_to(CLI::App& command) {
  const auto point = [&](const std::string& name, std::vector<double>& out, const std::string& help) {
    return command
        .add_option_function<std::string>(
            name, [name, &out](const std::string& text) { out = parse_point(name, text); }, help)
        ->type_name("X,Y,Z");
  };
  command.add_option("SCENE", scene_path, scene_help)->required()->type_name("FILE");
  file.add_to(command);
  command.add_option("--time", time_s, "Time of the scene's animations [s]")
      ->check(check_finite)
      ->capture_default_str();
  CLI::Option* camera =
      command.add_option("--camera", camera_index, "Camera of the file, counted from 0")->check(CLI::NonNegativeNumber);
  CLI::Option* from = point("--eye", eye, "Camera position in the file's frame [m]");
  CLI::Option* to = point("--target", target, "Point that --eye looks at [m]");
  from->needs(to)->excludes(camera);
  to->needs(from)->excludes(camera);
  command.add_option("--yfov", yfov_deg, "Vertical field of view of --eye [degrees]")
      ->check(CLI::Range(0.1, 179.0))
      ->needs(from)
      ->capture_default_str();
  light.add_to(command);
  command.add_option("--size", size_text, "Picture size in pixels")->type_name("WxH")->capture_default_str();
}

glm::ivec2 SceneOptions::size() const {
  const std::string_view text = size_text;
  const size_t x = text.find('x');
  const auto width = parse_number<int>(text.substr(0, x));
  const auto height = x == std::string_view::npos ? std::nullopt : parse_number<int>(text.substr(x + 1));
  const auto in_range = [](std::optional<int> edge) { return edge && *edge >= 1 && *edge <= largest_edge; };
  if (!in_range(width) || !in_range(height)) {
    throw Error(ExitCode::usage,
                fmt::format("--size '{}': give WxH with both from 1 to {}, such as 512x512", size_text, largest_edge));
  }
  return {*width, *height};
}

void SceneOptions::add_default_lamp(Scene& scene, const Camera& camera) const {
  const auto shines = [&](const Mesh& mesh) { return scene.materials[size_t(mesh.material)].is_emissive(); };
  const bool has_sky = scene.sky && scene.sky != default_sky;  // of an earlier frame
  if (!scene.lights.empty() || has_sky || std::any_of(scene.meshes.begin(), scene.meshes.end(), shines)) return;
  if (no_default_light || scene.triangle_count() == 0) {
    warn_once(fmt::format("{}: no light and nothing that glows: the picture is black", scene.name));
    return;
  }
  const glm::vec3 from(camera.world_from_camera[3]), up(camera.world_from_camera[1]),
      right(camera.world_from_camera[0]);
  const glm::vec3 middle = 0.5f * (scene.bounds_min + scene.bounds_max);
  // As far as what is looked at, at least a tenth of the scene; a little beside the camera, so that there are shadows.
  const float distance =
      std::max(glm::distance(from, middle), 0.1f * glm::distance(scene.bounds_min, scene.bounds_max));
  Light lamp;
  lamp.name = "default lamp";
  lamp.type = Light::Type::point;
  lamp.position = from + 0.05f * distance * up + 0.03f * distance * right;
  lamp.intensity = glm::vec3(glm::pi<float>() * distance * distance);
  scene.lights.push_back(lamp);
  constexpr float SOFT = 0.25f;  // beside the 1 that the lamp makes of white at that distance
  if (!default_sky) default_sky = std::make_shared<Sky>(glm::vec3(SOFT));
  scene.sky = default_sky;
  warn_once(fmt::format(
      "{}: no light and nothing that glows: a soft sky, and a lamp beside the camera; --lamp X,Y,Z,I, --sun "
      "or --sky choose another, --no-default-light leaves it out",
      scene.name));
}

Camera SceneOptions::camera(const Scene& scene) const {
  if (!eye.empty()) {
    if (eye == target) throw Error(ExitCode::usage, "--eye and --target are the same point; move one of them");
    const float yfov_rad = float(glm::radians(yfov_deg));
    return look_at_camera(centred(eye, scene), centred(target, scene), yfov_rad, scene.bounds_min, scene.bounds_max);
  }
  const size_t count = scene.cameras.size();
  if (camera_index) {
    if (*camera_index >= 0 && size_t(*camera_index) < count) return scene.cameras[size_t(*camera_index)];
    throw Error(ExitCode::usage, fmt::format("--camera {}: {} has {} camera(s), counted from 0", *camera_index,
                                             scene.path.string(), count));
  }
  if (count > 0) return scene.cameras.front();
  if (made_camera) return *made_camera;
  made_camera = room_camera(scene);
  warn_once(fmt::format("{}: no camera; {}; --eye and --target choose another", scene.path.string(),
                        made_camera ? "one stands inside" : "the whole scene is framed"));
  if (!made_camera) made_camera = framing_camera(scene.bounds_min, scene.bounds_max);
  return *made_camera;
}

}  // namespace volgi::app
