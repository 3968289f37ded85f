#include "core/metaballs.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "core/marching_cubes.h"

namespace volgi {

namespace {

constexpr float kThreshold = 0.25f;
constexpr int kCells = 39;           // of the lattice along each axis of the room: 5000 triangles in the mean
constexpr float kHalfRoom_m = 1.0f;  // the room is centred on the origin

/// centre(t) = middle + reach * sin(2 pi (turns t / period + phase)) on each axis.
struct Orbit {
  glm::dvec3 middle, reach, turns, phase;
  double radius_m;
};

// Whole turns in a period, so that the movement repeats; phases and reaches without any rule, so that balls meet and
// part at different times.
constexpr double kThird = 1.0 / 3.0;
const std::array<Orbit, Metaballs::kCount> kOrbits{{
    {{0.0, -0.20, 0.0}, {0.46, 0.22, 0.30}, {1, 2, 1}, {0.00, 0.10, 0.25}, 0.44},
    {{0.0, 0.10, 0.0}, {0.48, 0.30, 0.34}, {1, 1, 2}, {0.50, 0.35, 0.60}, 0.42},
    {{0.1, -0.30, 0.1}, {0.38, 0.20, 0.38}, {2, 1, 1}, {0.20, 0.70, 0.05}, 0.40},
    {{-0.1, 0.0, 0.0}, {0.36, 0.44, 0.36}, {1, 2, 3}, {0.80, 0.00, 0.45}, 0.38},
    {{0.0, 0.20, -0.1}, {0.54, 0.24, 0.32}, {2, 3, 1}, {0.65, 0.55, 0.85}, 0.36},
    {{0.1, -0.10, -0.1}, {0.42, 0.50, 0.42}, {1, 1, 1}, {kThird, 0.90, 0.15}, 0.38},
    {{-0.1, -0.40, 0.1}, {0.46, 0.12, 0.44}, {1, 3, 2}, {0.90, 0.25, 0.75}, 0.40},
    {{0.0, 0.30, 0.0}, {0.50, 0.20, 0.46}, {3, 1, 2}, {0.45, 0.60, 0.30}, 0.34},
}};

float cubed(float x) { return x * x * x; }

Metaballs::Ball ball_at(const Orbit& orbit, double time_s) {
  const glm::dvec3 angle = glm::two_pi<double>() * (orbit.turns * (time_s / Metaballs::kPeriod_s) + orbit.phase);
  const glm::dvec3 centre = orbit.middle + orbit.reach * glm::sin(angle);
  return {glm::vec3(centre), float(orbit.radius_m)};
}

/// The field at the nodes of a lattice over the room: each ball adds what it is to the nodes within its radius.
FieldSamples sample(const Metaballs& metaballs) {
  FieldSamples field;
  field.nodes = glm::ivec3(kCells + 1);
  field.spacing_m = 2.0f * kHalfRoom_m / float(kCells);
  field.origin = glm::vec3(-kHalfRoom_m);
  field.values.assign(size_t(field.nodes.x) * size_t(field.nodes.y) * size_t(field.nodes.z), -kThreshold);
  for (const Metaballs::Ball& ball : metaballs.balls()) {
    const glm::vec3 middle = (ball.centre - field.origin) / field.spacing_m;
    const float reach = ball.radius_m / field.spacing_m;
    const glm::ivec3 first = glm::max(glm::ivec3(glm::ceil(middle - reach)), glm::ivec3(0));
    const glm::ivec3 last = glm::min(glm::ivec3(glm::floor(middle + reach)), field.nodes - 1);
    for (int z = first.z; z <= last.z; ++z) {
      for (int y = first.y; y <= last.y; ++y) {
        float* row = &field.values[field.index({0, y, z})];
        for (int x = first.x; x <= last.x; ++x) {
          const glm::vec3 d = (glm::vec3(x, y, z) - middle) / reach;
          row[x] += cubed(std::max(1.0f - glm::dot(d, d), 0.0f));
        }
      }
    }
  }
  return field;
}

Mesh mesh_of(const char* name, std::uint32_t object_id, int material) {
  Mesh mesh;
  mesh.name = name;
  mesh.object_id = object_id;
  mesh.material = material;
  return mesh;
}

/// A rectangle whose front looks along cross(u, v).
void add_rectangle(Mesh& mesh, glm::vec3 corner, glm::vec3 u, glm::vec3 v) {
  const auto first = std::uint32_t(mesh.positions.size());
  for (const glm::vec3& p : {corner, corner + u, corner + u + v, corner + v}) {
    mesh.positions.push_back(p);
    mesh.normals.push_back(glm::normalize(glm::cross(u, v)));
  }
  mesh.triangles.emplace_back(first, first + 1, first + 2);
  mesh.triangles.emplace_back(first, first + 2, first + 3);
}

Material matt(const char* name, glm::vec3 albedo) {
  Material m;
  m.name = name;
  m.base_color_factor = glm::vec4(albedo, 1.0f);
  m.metallic_factor = 0.0f;
  m.specular_factor = 0.0f;
  return m;
}

enum : int { kWhite, kRed, kGreen, kOchre };

/// Shell of data/cornell.glb, in its centred frame.
void add_room(Scene& scene) {
  scene.materials = {matt("white", {0.75f, 0.75f, 0.75f}), matt("red", {0.63f, 0.065f, 0.05f}),
                     matt("green", {0.14f, 0.45f, 0.091f}), matt("ochre", {0.8f, 0.6f, 0.3f})};
  const float h = kHalfRoom_m;
  const glm::vec3 x(2 * h, 0, 0), y(0, 2 * h, 0), z(0, 0, 2 * h);
  Mesh white = mesh_of("white_walls", 1, kWhite);
  add_rectangle(white, {-h, -h, -h}, z, x);  // floor
  add_rectangle(white, {-h, h, -h}, x, z);   // ceiling
  add_rectangle(white, {-h, -h, -h}, x, y);  // back
  Mesh left = mesh_of("left_wall", 2, kRed);
  add_rectangle(left, {-h, -h, -h}, y, z);
  Mesh right = mesh_of("right_wall", 3, kGreen);
  add_rectangle(right, {h, -h, -h}, z, y);
  scene.meshes = {white, left, right, mesh_of("metaballs", 4, kOchre)};
}

void add_light_and_camera(Scene& scene) {
  Light spot;
  spot.name = "spot";
  spot.type = Light::Type::spot;
  spot.position = glm::vec3(0.0f, kHalfRoom_m - 0.03125f, 0.0f);
  spot.direction = glm::vec3(0.0f, -1.0f, 0.0f);
  spot.intensity = glm::vec3(8.0f);
  spot.inner_cone_rad = glm::radians(49.5f);
  spot.outer_cone_rad = glm::radians(50.0f);
  scene.lights = {spot};
  Camera camera;
  camera.name = "camera";
  camera.yfov_rad = glm::radians(40.0f);
  camera.zfar = 50.0f;
  camera.world_from_camera = glm::translate(glm::mat4(1.0f), glm::vec3(0.0390625f, 0.0234375f, 3.90625f));
  scene.cameras = {camera};
}

}  // namespace

Metaballs::Metaballs(double time_s) {
  std::transform(kOrbits.begin(), kOrbits.end(), balls_.begin(),
                 [&](const Orbit& orbit) { return ball_at(orbit, time_s); });
}

float Metaballs::value(glm::vec3 position) const {
  float sum = -kThreshold;
  for (const Ball& ball : balls_) {
    const glm::vec3 d = (position - ball.centre) / ball.radius_m;
    sum += cubed(std::max(1.0f - glm::dot(d, d), 0.0f));
  }
  return sum;
}

glm::vec3 Metaballs::outward_normal(glm::vec3 position) const {
  glm::vec3 sum(0.0f);
  for (const Ball& ball : balls_) {
    const glm::vec3 d = (position - ball.centre) / ball.radius_m;
    const float q = std::max(1.0f - glm::dot(d, d), 0.0f);
    sum += q * q / ball.radius_m * d;  // the gradient is -6 times this
  }
  const float length = glm::length(sum);
  return length > 1e-6f ? sum / length : glm::vec3(0.0f, 1.0f, 0.0f);
}

void move_metaballs(Scene& scene, double time_s) {
  const Metaballs metaballs(time_s);
  Isosurface surface = marching_cubes(sample(metaballs), [&](glm::vec3 p) { return metaballs.value(p); });
  Mesh& mesh = scene.meshes.back();
  mesh.positions = std::move(surface.positions);
  mesh.triangles = std::move(surface.triangles);
  mesh.normals.resize(mesh.positions.size());
  std::transform(mesh.positions.begin(), mesh.positions.end(), mesh.normals.begin(),
                 [&](glm::vec3 p) { return metaballs.outward_normal(p); });
}

Scene metaballs_scene(double time_s) {
  Scene scene;
  scene.name = "metaballs";
  scene.path = "builtin:metaballs";
  scene.world_origin = metaballs_bounds().centre();
  add_room(scene);
  add_light_and_camera(scene);
  move_metaballs(scene, time_s);
  update_bounds(scene);
  return scene;
}

WorldBox metaballs_bounds() {
  const double h = double(kHalfRoom_m);
  return {{-h, 0.0, -h}, {h, 2.0 * h, h}};
}

}  // namespace volgi
