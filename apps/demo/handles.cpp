#include "apps/demo/handles.h"

#include <fmt/format.h>
#include <imgui.h>

#include <array>

#include "apps/demo/commands.h"
#include "core/error.h"

namespace volgi::demo {

namespace {

constexpr float NEAR_PIXELS = 10.0f;
constexpr std::array AXES = {glm::vec3(1.0f, 0.0f, 0.0f), glm::vec3(0.0f, 1.0f, 0.0f), glm::vec3(0.0f, 0.0f, 1.0f)};
constexpr std::array<ImU32, 3> AXIS_COLOURS = {IM_COL32(240, 90, 80, 255), IM_COL32(110, 210, 90, 255),
                                               IM_COL32(90, 150, 250, 255)};
constexpr ImU32 MARK = IM_COL32(255, 215, 120, 230), TAKEN = IM_COL32(255, 255, 255, 255),
                DARK = IM_COL32(0, 0, 0, 160);

/// Where on a line the point is that is nearest to a ray; along its direction, which has length 1.
float along_line(glm::vec3 point, glm::vec3 direction, const CameraRay& ray) {
  const float cosine = glm::dot(direction, ray.direction);
  const float across = 1.0f - cosine * cosine;
  if (across < 1e-6f) return 0.0f;
  const glm::vec3 between = point - ray.origin;
  return (cosine * glm::dot(ray.direction, between) - glm::dot(direction, between)) / across;
}

float distance_to_segment(glm::vec2 p, glm::vec2 a, glm::vec2 b) {
  const float length2 = glm::dot(b - a, b - a);
  const float t = length2 > 0.0f ? glm::clamp(glm::dot(p - a, b - a) / length2, 0.0f, 1.0f) : 0.0f;
  return glm::distance(p, a + t * (b - a));
}

ImVec2 im(glm::vec2 v) { return {v.x, v.y}; }

}  // namespace

const Light* Handles::taken() const {
  if (!viewer_.session.has_scene() || !viewer_.taken_light) return nullptr;
  const auto& lights = viewer_.session.document().lights();
  return *viewer_.taken_light < lights.size() ? &lights[*viewer_.taken_light] : nullptr;
}

/// A sun has no place: it is marked over the middle of the scene.
glm::vec3 Handles::mark(const Light& light) const {
  const Scene& scene = viewer_.session.document().scene();
  if (light.type != Light::Type::directional) return light.position;
  return 0.5f * (scene.bounds_min + scene.bounds_max) -
         0.3f * glm::distance(scene.bounds_min, scene.bounds_max) * light.direction;
}

float Handles::arm_m(const Light& light) const {
  constexpr float SHARE_OF_DISTANCE = 0.15f;
  return SHARE_OF_DISTANCE * glm::distance(mark(light), glm::vec3(viewer_.session.camera().world_from_camera[3]));
}

glm::vec3 Handles::direction_end(const Light& light) const {
  return mark(light) + 1.6f * arm_m(light) * light.direction;
}

std::optional<glm::vec2> Handles::pixel_of(glm::vec3 position) const {
  const Camera& camera = viewer_.session.camera();
  const glm::ivec2 size = viewer_.session.size();
  const glm::vec4 clip = clip_from_camera(camera, size) * camera_from_world(camera) * glm::vec4(position, 1.0f);
  if (clip.w <= 1e-6f) return std::nullopt;
  const glm::vec2 ndc = glm::vec2(clip) / clip.w;
  return glm::vec2(0.5f + 0.5f * ndc.x, 0.5f - 0.5f * ndc.y) * glm::vec2(size);
}

void Handles::draw() const {
  if (!viewer_.session.has_picture()) return;
  ImDrawList* list = ImGui::GetBackgroundDrawList();
  const auto& lights = viewer_.session.document().lights();
  for (size_t k = 0; k < lights.size(); ++k) {
    const auto at = pixel_of(mark(lights[k]));
    if (!at) continue;
    list->AddCircleFilled(im(*at), 6.0f, DARK);
    list->AddCircle(im(*at), 5.0f, viewer_.taken_light == k ? TAKEN : MARK, 0, 2.0f);
    const auto end = pixel_of(direction_end(lights[k]));
    if (lights[k].type != Light::Type::point && end) list->AddLine(im(*at), im(*end), MARK, 1.0f);
  }
  const Light* light = taken();
  if (light == nullptr) return;
  const auto from = pixel_of(mark(*light));
  if (!from) return;
  if (light->type != Light::Type::directional) {
    for (size_t axis = 0; axis < AXES.size(); ++axis) {
      const auto end = pixel_of(light->position + arm_m(*light) * AXES[axis]);
      if (!end) continue;
      list->AddLine(im(*from), im(*end), AXIS_COLOURS[axis], 2.5f);
      list->AddCircleFilled(im(*end), 4.5f, AXIS_COLOURS[axis]);
    }
  }
  const auto end = pixel_of(direction_end(*light));
  if (light->type != Light::Type::point && end) list->AddCircleFilled(im(*end), 6.0f, MARK);
}

bool Handles::press(glm::vec2 pixel) {
  held_.reset();
  if (!viewer_.session.has_picture()) return false;
  if (const Light* light = taken()) {
    const auto from = pixel_of(mark(*light));
    const auto end = pixel_of(direction_end(*light));
    if (light->type != Light::Type::point && end && glm::distance(pixel, *end) < NEAR_PIXELS) {
      held_ = Held{Part::direction, *light, pixel};
      return true;
    }
    if (from && light->type != Light::Type::directional) {
      if (glm::distance(pixel, *from) < NEAR_PIXELS) {
        held_ = Held{Part::plane, *light, pixel};
        return true;
      }
      for (size_t axis = 0; axis < AXES.size(); ++axis) {
        const auto tip = pixel_of(light->position + arm_m(*light) * AXES[axis]);
        if (!tip || distance_to_segment(pixel, *from, *tip) > 0.6f * NEAR_PIXELS) continue;
        held_ = Held{Part(axis), *light, pixel};
        return true;
      }
    }
  }
  const auto& lights = viewer_.session.document().lights();
  for (size_t k = 0; k < lights.size(); ++k) {
    const auto at = pixel_of(mark(lights[k]));
    if (!at || glm::distance(pixel, *at) > NEAR_PIXELS) continue;
    viewer_.taken_light = k;
    held_ = Held{Part::plane, lights[k], pixel};
    if (lights[k].type == Light::Type::directional) held_.reset();
    return true;
  }
  return false;
}

/// Where the hand takes the light.
glm::vec3 Handles::moved_to(const Held& held, glm::vec2 pixel) const {
  const Session& session = viewer_.session;
  const CameraRay before = camera_ray(session.camera(), held.from, session.size());
  const CameraRay now = camera_ray(session.camera(), pixel, session.size());
  const glm::vec3 start = held.before.position;
  if (held.part != Part::plane) {
    const glm::vec3 axis = AXES[size_t(held.part)];
    return start + axis * (along_line(start, axis, now) - along_line(start, axis, before));
  }
  // In the plane of the picture through the light.
  const glm::vec3 back(session.camera().world_from_camera[2]);
  const auto meet = [&](const CameraRay& ray) {
    return ray.origin + ray.direction * (glm::dot(back, start - ray.origin) / glm::dot(back, ray.direction));
  };
  return start + meet(now) - meet(before);
}

void Handles::drag(glm::vec2 pixel) {
  const Light* light = taken();
  if (!held_ || light == nullptr) return;
  Light moved = *light;
  if (held_->part == Part::direction) {
    // On the sphere of the handle, as far as the ray passes it.
    const CameraRay ray = camera_ray(viewer_.session.camera(), pixel, viewer_.session.size());
    const glm::vec3 centre = mark(held_->before);
    const float radius = 1.6f * arm_m(held_->before);
    const float middle = glm::dot(centre - ray.origin, ray.direction);
    const glm::vec3 nearest = ray.origin + middle * ray.direction;
    const float inside = radius * radius - glm::dot(nearest - centre, nearest - centre);
    const glm::vec3 back(viewer_.session.camera().world_from_camera[2]);
    const float side = glm::dot(held_->before.direction, back) > 0.0f ? -1.0f : 1.0f;
    const glm::vec3 end = inside > 0.0f ? nearest + side * std::sqrt(inside) * ray.direction : nearest;
    if (glm::distance(end, centre) > 0.0f) moved.direction = glm::normalize(end - centre);
  } else {
    moved.position = moved_to(*held_, pixel);
  }
  viewer_.session.document().set_light(*viewer_.taken_light, moved);
  viewer_.session.light_changed(false);
}

}  // namespace volgi::demo
