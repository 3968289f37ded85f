#include "apps/demo/document.h"

#include <algorithm>
#include <glm/gtc/constants.hpp>

#include "apps/demo/volume_viewer.h"
#include "core/error.h"
#include "core/log.h"
#include "core/sky.h"
#include "core/visibility/room_camera.h"
#include "propagation/light_in/automatic_grid.h"

namespace volgi::demo {

Document::Document(std::vector<std::filesystem::path> files, const app::LightOptions& light, double time_s,
                   SceneReading reading)
    : files_(std::move(files)), reading_(std::move(reading)), light_(light), time_s_(time_s) {
  for (const std::filesystem::path& file : files_) {
    if (is_volume_file(file))
      throw Error(ExitCode::bad_input, file.string() + ": a volume, not a scene: volgi-demo with its name looks at it");
    sources_.push_back(std::make_unique<SceneSource>(file, reading_));
  }
  if (moves()) {
    for (const auto& source : sources_) box_.add(source->whole_bounds());
    for (const auto& source : sources_) parts_.push_back(source->at(time_s, box_));
  } else {
    for (const auto& source : sources_) parts_.push_back(source->at(0.0));
  }
  scene_ = parts_.front();
  for (size_t k = 1; k < parts_.size(); ++k) append_scene(scene_, parts_[k]);
  if (scene_.triangle_count() == 0)
    throw Error(ExitCode::bad_input, title() + ": no triangles, there is nothing to see");
  for (const Material& m : scene_.materials) emission_of_file_.push_back(m.emissive_radiance);
  grid_cells_ = automatic_grid_cells(scene_);
  if (scene_.cameras.empty()) {
    const std::optional<Camera> inside = room_camera(scene_);
    made_camera_ = inside ? *inside : framing_camera(scene_.bounds_min, scene_.bounds_max);
  }
  if (parts_.size() == 1) parts_.clear();
  lights_of_files_ = scene_.lights;
  film_s_ = light_.video.duration_s();
  light_.video.show(scene_, time_s);
  light_up();
}

std::string Document::title() const {
  std::string names;
  for (const std::filesystem::path& file : files_) names += (names.empty() ? "" : " + ") + file.filename().string();
  return names;
}

bool Document::animated() const { return moves() || light_.video.plays(); }

bool Document::moves() const {
  return std::any_of(sources_.begin(), sources_.end(), [](const auto& source) { return source->animated(); });
}

double Document::duration_s() const {
  double longest = film_s_;
  for (const auto& source : sources_) longest = std::max(longest, source->animated() ? source->duration_s() : 0.0);
  return longest;
}

bool Document::move(double time_s) {
  if (moves()) move_sources(time_s);
  if (animated()) time_s_ = time_s;
  return light_.video.show(scene_, time_s);
}

void Document::move_sources(double time_s) {
  scene_.lights = lights_of_files_;  // what moves them knows no others, and leaves those that stand still
  if (parts_.empty()) {
    sources_.front()->move(scene_, time_s, box_);
  } else {
    for (size_t k = 0; k < parts_.size(); ++k) {
      if (sources_[k]->animated()) sources_[k]->move(parts_[k], time_s, box_);
    }
    const std::vector<Material> materials = std::move(scene_.materials);  // as changed
    scene_ = parts_.front();
    for (size_t k = 1; k < parts_.size(); ++k) append_scene(scene_, parts_[k]);
    scene_.materials = materials;
    light_.video.forget_shown();  // images are the files' again
  }
  lights_of_files_ = scene_.lights;
  light_up();
}

/// The files' lights are in the scene: what is to be there instead.
void Document::light_up() {
  scene_.sky.reset();
  for (size_t m = 0; m < scene_.materials.size(); ++m) scene_.materials[m].emissive_radiance = emission_of_file_[m];
  light_.apply(scene_);
  places_ = scene_.lights.size();
  std::vector<Light> lights;
  place_of_.clear();
  for (size_t place = 0; place < places_; ++place) {
    if (std::find(removed_.begin(), removed_.end(), place) != removed_.end()) continue;
    const auto changed = changed_.find(place);
    lights.push_back(changed != changed_.end() ? changed->second : scene_.lights[place]);
    place_of_.push_back(place);
  }
  for (const Light& light : added_) lights.push_back(light);
  scene_.lights = std::move(lights);
  for (const auto& [material, radiance] : emission_) scene_.materials[material].emissive_radiance = radiance;
  if (!light_changed()) add_default_light();
}

bool Document::shines() const {
  return !scene_.lights.empty() || scene_.sky ||
         std::any_of(scene_.meshes.begin(), scene_.meshes.end(),
                     [&](const Mesh& mesh) { return scene_.materials[size_t(mesh.material)].is_emissive(); });
}

/// A soft sky and a lamp as `volgi render` has them where nothing shines; as lights that somebody has added, so that
/// they can be moved and go with the picture's command.
void Document::add_default_light() {
  if (shines()) return;
  default_light_ = true;
  const Camera camera = first_camera();
  const glm::vec3 from(camera.world_from_camera[3]), up(camera.world_from_camera[1]),
      right(camera.world_from_camera[0]);
  const glm::vec3 middle = 0.5f * (scene_.bounds_min + scene_.bounds_max);
  const float distance =
      std::max(glm::distance(from, middle), 0.1f * glm::distance(scene_.bounds_min, scene_.bounds_max));
  Light lamp;
  lamp.name = "default lamp";
  lamp.position = from + 0.05f * distance * up + 0.03f * distance * right;
  lamp.intensity = glm::vec3(glm::pi<float>() * distance * distance);
  added_.push_back(lamp);
  light_.sky = "0.25,0.25,0.25";
  light_up();
}

void Document::set_light(size_t index, const Light& light) {
  scene_.lights[index] = light;
  if (index < place_of_.size()) {
    changed_[place_of_[index]] = light;
  } else {
    added_[index - place_of_.size()] = light;
  }
}

size_t Document::add_light(const Light& light) {
  added_.push_back(light);
  scene_.lights.push_back(light);
  return scene_.lights.size() - 1;
}

void Document::remove_light(size_t index) {
  if (index < place_of_.size()) {
    removed_.push_back(place_of_[index]);
    place_of_.erase(place_of_.begin() + std::ptrdiff_t(index));
  } else {
    added_.erase(added_.begin() + std::ptrdiff_t(index - place_of_.size()));
  }
  scene_.lights.erase(scene_.lights.begin() + std::ptrdiff_t(index));
}

void Document::set_emission(size_t material, glm::vec3 radiance) {
  emission_[material] = radiance;
  scene_.materials[material].emissive_radiance = radiance;
}

void Document::reset_light() {
  changed_.clear();
  added_.clear();
  removed_.clear();
  emission_.clear();
  if (std::exchange(default_light_, false)) light_.set_sky({}, 0.0);
  scene_.lights = lights_of_files_;
  light_up();
}

LightFile Document::light_file() const {
  LightFile file;
  file.lights = scene_.lights;
  for (const auto& [material, radiance] : emission_) file.emissive_radiance[int(material)] = radiance;
  return file;
}

void Document::set_sky(const std::string& sky, double rotate_deg) {
  app::LightOptions with_sky;
  with_sky.set_sky(sky, rotate_deg);
  Scene trial;
  with_sky.apply(trial);  // says what is wrong before anything is changed
  light_.set_sky(sky, rotate_deg);
  default_light_ = false;
  scene_.lights = lights_of_files_;  // a clear sky brings its sun
  light_up();
}

}  // namespace volgi::demo
