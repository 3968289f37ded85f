#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "core/gltf/gltf_internal.h"

namespace volgi::gltf {
namespace {

constexpr double infinitely_far_m = 1e11;
constexpr double largest_intensity = 1e18;  // its square root is still a float's distance

Light read_light(const Document& document, size_t index) {
  const tinygltf::Light& in = document.model.lights[index];
  const std::string who = element("light", index, in.name);
  Light light;
  light.name = in.name;
  if (in.type == "point") {
    light.type = Light::Type::point;
  } else if (in.type == "spot") {
    light.type = Light::Type::spot;
  } else if (in.type == "directional") {
    light.type = Light::Type::directional;
  } else {
    refuse(document.path, fmt::format("{} has the unknown type '{}'", who, in.type));
  }

  std::vector<double> color = in.color.empty() ? std::vector<double>{1.0, 1.0, 1.0} : in.color;
  const auto is_power = [](double value) { return value >= 0.0 && value <= largest_intensity; };
  if (color.size() != 3 || !is_power(in.intensity) || !std::all_of(color.begin(), color.end(), is_power)) {
    refuse(document.path, fmt::format("{}: its colour or intensity is not a finite number from 0 up", who));
  }
  light.intensity = glm::vec3(in.intensity * glm::dvec3(color[0], color[1], color[2]));
  if (!(in.range >= 0.0)) refuse(document.path, fmt::format("{}: its range is {}", who, in.range));
  light.range_m = in.range > infinitely_far_m ? 0.0f : float(in.range);
  if (light.type == Light::Type::spot) {
    double inner = in.spot.innerConeAngle;
    double outer = in.spot.outerConeAngle;
    if (outer > glm::half_pi<double>() + 1e-6) {
      repair(document, fmt::format("{}: its outer cone angle {} is larger than pi/2, which counts", who, outer));
      outer = glm::half_pi<double>();
    }
    if (inner > outer && outer > 0.0) {
      repair(document, fmt::format("{}: its inner cone angle {} is larger than the outer one, {}, which counts", who,
                                   inner, outer));
      inner = outer;
    }
    if (!(inner >= 0.0 && inner <= outer && outer > 0.0 && outer <= glm::half_pi<double>() + 1e-6)) {
      refuse(document.path,
             fmt::format("{}: its cone angles must be 0 <= inner <= outer <= pi/2, not {} and {}", who, inner, outer));
    }
    light.inner_cone_rad = float(inner);
    light.outer_cone_rad = float(outer);
  }
  return light;
}

bool is_used(const Document& document, int camera) {
  const auto& nodes = document.model.nodes;
  return std::any_of(nodes.begin(), nodes.end(), [&](const tinygltf::Node& node) { return node.camera == camera; });
}

Camera read_camera(const Document& document, size_t index) {
  const tinygltf::Camera& in = document.model.cameras[index];
  const std::string who = element("camera", index, in.name);
  Camera camera;
  camera.name = in.name;
  double near = 0.0, far = 0.0;
  bool good = false;
  if (in.type == "perspective") {
    camera.kind = Camera::Kind::perspective;
    camera.yfov_rad = float(in.perspective.yfov);
    near = in.perspective.znear;
    far = in.perspective.zfar;
    good = in.perspective.yfov > 0.0 && in.perspective.yfov < glm::pi<double>() && near > 0.0 &&
           (far == 0.0 || far > near);
  } else {
    camera.kind = Camera::Kind::orthographic;
    camera.ymag = float(std::abs(in.orthographic.ymag));
    near = in.orthographic.znear;
    far = in.orthographic.zfar;
    good = camera.ymag > 0.0f && near >= 0.0 && far > near;
  }
  if (far > infinitely_far_m) far = 0.0;
  if (!good || !(camera.ymag < 1e12f)) {
    if (!is_used(document, int(index))) return camera;
    refuse(document.path, fmt::format("{}: its field of view, znear or zfar makes no sense", who));
  }
  camera.znear = float(near);
  camera.zfar = float(far);
  return camera;
}

}  // namespace

std::vector<Light> read_lights(const Document& document) {
  std::vector<Light> lights;
  for (size_t i = 0; i < document.model.lights.size(); ++i) lights.push_back(read_light(document, i));
  return lights;
}

std::vector<Camera> read_cameras(const Document& document) {
  std::vector<Camera> cameras;
  for (size_t i = 0; i < document.model.cameras.size(); ++i) cameras.push_back(read_camera(document, i));
  return cameras;
}

Light place_light(Light light, const glm::dmat4& world_from_node, const glm::dvec3& world_origin) {
  light.position = glm::vec3(glm::dvec3(world_from_node[3]) - world_origin);
  const glm::dvec3 forward = -glm::dvec3(world_from_node[2]);
  const double length = glm::length(forward);
  if (length > 0.0) light.direction = glm::vec3(forward / length);
  return light;
}

/// The view is the inverse of the node's transform, without its scale (glTF 2.0, 3.10.2) and without shear: a camera
/// below a root that turns centimetres into metres keeps its field of view, and its planes as they are written.
Camera place_camera(const std::filesystem::path& file, Camera camera, const glm::dmat4& world_from_node,
                    const glm::dvec3& world_origin) {
  const glm::dmat3 axes(world_from_node);
  const glm::dvec3 scale(glm::length(axes[0]), glm::length(axes[1]), glm::length(axes[2]));
  const glm::dvec3 back = axes[2] / scale.z;
  glm::dvec3 up = axes[1] - back * glm::dot(back, axes[1]);
  constexpr double smallest = 1e-12;
  if (!(scale.y > smallest && scale.z > smallest) || !(glm::length(up) > 1e-9 * scale.y)) {
    refuse(file, fmt::format("camera '{}': its node's scale is zero", camera.name));
  }
  up = glm::normalize(up);
  const double handedness = glm::determinant(axes) < 0.0 ? -1.0 : 1.0;
  const glm::dvec3 right = glm::cross(up, back) * handedness;
  const glm::dvec3 position = glm::dvec3(world_from_node[3]) - world_origin;
  camera.world_from_camera = glm::mat4(
      glm::dmat4(glm::dvec4(right, 0.0), glm::dvec4(up, 0.0), glm::dvec4(back, 0.0), glm::dvec4(position, 1.0)));
  return camera;
}

void finite_far_plane(Camera& camera, glm::vec3 bounds_min, glm::vec3 bounds_max) {
  if (camera.zfar > 0.0f) return;
  const glm::vec3 eye(camera.world_from_camera[3]);
  const glm::vec3 far_corner = glm::max(glm::abs(bounds_min - eye), glm::abs(bounds_max - eye));
  camera.zfar = std::max(1.01f * glm::length(far_corner), 2.0f * camera.znear);
}

}  // namespace volgi::gltf
