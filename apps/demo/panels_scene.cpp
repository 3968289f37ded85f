// Panels of the scene: files and time, light, cameras.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>

#include "apps/demo/panels.h"
#include "core/sky.h"

namespace volgi::demo {

namespace {

const char* type_name(Light::Type type) {
  constexpr const char* NAMES[] = {"point", "spot", "sun"};
  return NAMES[int(type)];
}

float largest(glm::vec3 v) { return std::max({v.x, v.y, v.z}); }

}  // namespace

void Panels::draw_scene() {
  Session& session = viewer_.session;
  ImGui::SetNextItemWidth(-ImGui::GetFontSize() * 4.0f);
  if (ImGui::InputTextWithHint("open", "a glTF file; or drop one", path_text_.data(), path_text_.size(),
                               ImGuiInputTextFlags_EnterReturnsTrue))
    run(fmt::format("open {}", path_text_.data()));
  if (ImGui::BeginCombo("##recent", "recent files")) {
    for (const std::filesystem::path& file : session.settings().recent_files) {
      if (ImGui::Selectable(file.string().c_str())) {
        run(fmt::format("open {}", file.string()));
        break;
      }
    }
    ImGui::EndCombo();
  }
  if (!session.has_scene()) return;
  const Document& document = session.document();
  const Scene& scene = document.scene();
  const glm::vec3 extent = scene.bounds_max - scene.bounds_min;
  ImGui::TextWrapped("%s", document.title().c_str());
  ImGui::Text("%zu triangles, %zu materials, %zu lights, %zu cameras", scene.triangle_count(), scene.materials.size(),
              scene.lights.size(), scene.cameras.size());
  ImGui::Text("%.3g x %.3g x %.3g m", double(extent.x), double(extent.y), double(extent.z));
  if (ImGui::Button("read anew")) run("reload");
  if (!document.animated()) return;
  ImGui::SameLine();
  if (ImGui::Button(session.playing() ? "pause" : "play")) run("play");
  ImGui::SameLine();
  if (ImGui::Button("step")) run("time +0.04");
  float time = float(document.time_s());
  ImGui::SetNextItemWidth(-ImGui::GetFontSize() * 4.0f);
  if (ImGui::SliderFloat("time", &time, 0.0f, float(document.duration_s()), "%.2f s"))
    run(fmt::format("time {}", time));
}

void Panels::draw_light() {
  const Document& document = viewer_.session.document();
  for (const char* type : {"point", "spot", "sun"}) {
    if (ImGui::Button(fmt::format("add {}", type).c_str())) run(fmt::format("light add {}", type));
    ImGui::SameLine();
  }
  if (ImGui::Button("as the file")) run("light reset");
  const auto& lights = document.lights();
  for (size_t k = 0; k < lights.size(); ++k) {
    const std::string label = fmt::format("{} {} {}##{}", k, type_name(lights[k].type), lights[k].name, k);
    if (ImGui::Selectable(label.c_str(), viewer_.taken_light == k)) run(fmt::format("light take {}", k));
  }
  if (viewer_.taken_light && *viewer_.taken_light < lights.size()) {
    const Light& light = lights[*viewer_.taken_light];
    const glm::dvec3 world = glm::dvec3(light.position) + document.scene().world_origin;
    glm::vec3 position(world), direction = light.direction,
                               colour = light.intensity / std::max(largest(light.intensity), 1e-30f);
    float intensity = largest(light.intensity);
    const float step = 0.002f * glm::distance(document.scene().bounds_min, document.scene().bounds_max);
    if (light.type != Light::Type::directional && ImGui::DragFloat3("at [m]", &position.x, step))
      run(fmt::format("light at {},{},{}", position.x, position.y, position.z));
    if (light.type != Light::Type::point && ImGui::DragFloat3("towards", &direction.x, 0.01f, -1.0f, 1.0f) &&
        glm::length(direction) > 0.0f)
      run(fmt::format("light towards {},{},{}", direction.x, direction.y, direction.z));
    const char* unit = light.type == Light::Type::directional ? "W/m2" : "W/sr";
    if (ImGui::DragFloat(unit, &intensity, std::max(0.01f * intensity, 1e-4f), 0.0f, 1e9f, "%.4g"))
      run(fmt::format("light intensity {}", intensity));
    if (ImGui::ColorEdit3("colour", &colour.x, ImGuiColorEditFlags_Float | ImGuiColorEditFlags_HDR)) {
      const glm::vec3 c = colour * largest(light.intensity);
      run(fmt::format("light colour {},{},{}", c.x, c.y, c.z));
    }
    if (ImGui::Button("delete")) run("light delete");
  }
  const auto& materials = document.scene().materials;
  for (size_t m = 0; m < materials.size(); ++m) {
    if (!materials[m].is_emissive()) continue;
    glm::vec3 radiance = materials[m].emissive_radiance;
    const std::string label = fmt::format("{}##{}", materials[m].name.empty() ? "emission" : materials[m].name, m);
    if (ImGui::DragFloat3(label.c_str(), &radiance.x, std::max(0.01f * largest(radiance), 1e-3f), 0.0f, 1e9f, "%.3g"))
      run(fmt::format("emission {} {},{},{}", m, radiance.x, radiance.y, radiance.z));
  }
  ImGui::SetNextItemWidth(-ImGui::GetFontSize() * 4.0f);
  const std::string hint = document.sky().empty() ? "none; R,G,B, FILE.exr or sun:35,120" : document.sky();
  if (ImGui::InputTextWithHint("sky", hint.c_str(), sky_text_.data(), sky_text_.size(),
                               ImGuiInputTextFlags_EnterReturnsTrue))
    run(fmt::format("sky {}", sky_text_.data()));
  float turn = float(document.sky_rotate_deg());
  if (!document.sky().empty() && ImGui::SliderFloat("turned", &turn, -180.0f, 180.0f, "%.0f deg"))
    run(fmt::format("sky-rotate {}", turn));
}

void Panels::draw_camera() {
  Session& session = viewer_.session;
  const auto& cameras = session.document().cameras();
  for (size_t k = 0; k < cameras.size(); ++k) {
    const std::string label = fmt::format("{} {}##file{}", k, cameras[k].name, k);
    if (ImGui::Selectable(label.c_str(), session.file_camera() == k)) run(fmt::format("camera {}", k));
  }
  for (const Bookmark& bookmark : std::vector<Bookmark>(viewer_.bookmarks())) {
    if (ImGui::Selectable(fmt::format("{}##kept", bookmark.name).c_str()))
      run(fmt::format("bookmark go {}", bookmark.name));
  }
  ImGui::SetNextItemWidth(ImGui::GetFontSize() * 9.0f);
  if (ImGui::InputTextWithHint("keep", "a name", bookmark_text_.data(), bookmark_text_.size(),
                               ImGuiInputTextFlags_EnterReturnsTrue))
    run(fmt::format("bookmark {}", bookmark_text_.data()));
  float degrees = glm::degrees(session.camera().yfov_rad);
  ImGui::SetNextItemWidth(ImGui::GetFontSize() * 9.0f);
  if (ImGui::SliderFloat("field of view", &degrees, 10.0f, 120.0f, "%.0f deg")) run(fmt::format("yfov {}", degrees));
  if (ImGui::Button("frame")) run("frame");
  ImGui::SameLine();
  if (ImGui::Button("copy")) run("copy camera");
  ImGui::SameLine();
  if (ImGui::Button(viewer_.recording() ? "stop" : "record")) run("record");
  ImGui::SameLine();
  if (ImGui::Button(viewer_.replaying() ? "stop##replay" : "replay")) run("replay");
}

}  // namespace volgi::demo
