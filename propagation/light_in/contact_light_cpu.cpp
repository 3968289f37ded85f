#include "propagation/light_in/contact_light_cpu.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <glm/gtc/constants.hpp>
#include <limits>

#include "core/hash.h"
#include "core/level.h"
#include "core/light.h"
#include "core/surface.h"
#include "propagation/light_in/cosine_direction_internal.h"
#include "voxel/side_search.h"

namespace volgi {
namespace {

constexpr int MOST_SURFACES = 32;  // of a path; 0.8^32 is 1e-3
constexpr float FAR = std::numeric_limits<float>::infinity();

float random(std::uint32_t& state) {
  state = hash(state);
  return float(state >> 8) * 0x1p-24f;
}

/// Irradiance by a lamp with nothing between, and how a ray to it goes.
glm::vec3 irradiance_of(const shared::PunctualLight& lamp, glm::vec3 at, glm::vec3 normal, glm::vec3& towards) {
  const glm::vec3 perpendicular = shared::perpendicular_irradiance(lamp, at, towards);
  return perpendicular * std::max(glm::dot(normal, towards), 0.0f);
}

/// What paths from one point have brought.
struct Brought {
  glm::vec3 sum{0.0f};
  float squares = 0.0f;

  void add(glm::vec3 b) {
    sum += b;
    squares += level(b) * level(b);
  }
  ContactPart mean(int paths) const {
    const glm::vec3 mean = sum / float(paths);
    const float scatter = std::max(squares / float(paths) - level(mean) * level(mean), 0.0f);
    return {mean, scatter / float(std::max(paths - 1, 1))};
  }
};

class Walk {
 public:
  Walk(const VoxelGrid& voxels, const EmbreeScene& embree, const ContactSides& sides)
      : voxels_(voxels), embree_(embree), sides_(sides), near_m_(NEAR_CELLS * voxels.grid().cell_size_m) {}

  ContactLight from(const ContactPoint& point, int paths) const {
    const glm::vec3 origin = embree_.leaving_point(point.position, point.way, point.distance_m);
    Brought near, far;
    for (int k = 0; k < paths; ++k) {
      const std::uint32_t n = hash(point.seed) + std::uint32_t(k);
      const glm::vec3 way = cosine_direction(point.normal, recurrence_in_square(n));
      Met met;
      const bool any = meet(origin, way, n, met);
      const bool is_near = any && met.distance_m <= near_m_;
      near.add(is_near ? along(met, n) : glm::vec3(0.0f));
      far.add(any && !is_near ? by_lamps(met, n) + met.passed * of_sides(sides_.radiosity, met) : glm::vec3(0.0f));
    }
    return {near.mean(paths), far.mean(paths)};
  }

 private:
  struct Met {
    glm::vec3 position, normal, leaving, albedo, emitted, passed;
    float distance_m;
  };

  bool meet(glm::vec3 origin, glm::vec3 way, std::uint32_t seed, Met& met) const {
    RayHit hit;
    if (!embree_.intersect(origin, way, FAR, seed, hit)) return false;
    const Scene& scene = embree_.scene();
    const Mesh& mesh = scene.meshes[hit.mesh];
    const SurfacePoint at = surface_point(scene, mesh, hit.triangle, hit.u, hit.v);
    const bool front = glm::dot(at.geometric_normal, way) < 0.0f;
    const bool emits = front || scene.materials[size_t(mesh.material)].double_sided;
    met = {at.position,
           front ? at.geometric_normal : -at.geometric_normal,
           embree_.leaving_point(at.position, way, hit.distance),
           at.albedo,
           emits ? glm::pi<float>() * at.emission : glm::vec3(0.0f),
           hit.tint,
           hit.distance};
    return true;
  }
  glm::vec3 by_lamps(const Met& met, std::uint32_t seed) const {
    return met.passed * radiosity_by_lamps(embree_, met.leaving, met.normal, met.albedo, hash(seed));
  }

  /// Radiosity of what is near, without what it emits: that comes straight to the point.
  glm::vec3 along(Met met, std::uint32_t seed) const {
    glm::vec3 sum(0.0f), passed(1.0f);
    for (int surface = 1;; ++surface) {
      sum += passed * by_lamps(met, seed);
      passed *= met.passed * met.albedo;
      sum += passed * of_sides(sides_.from_far, met);
      if (surface == MOST_SURFACES || passed == glm::vec3(0.0f)) return sum;
      const float u = random(seed), v = random(seed);
      const glm::vec3 way = cosine_direction(met.normal, {u, v});
      if (!meet(met.leaving, way, seed, met) || met.distance_m > near_m_) return sum;
      sum += passed * met.passed * met.emitted;
    }
  }

  glm::vec3 of_sides(std::span<const glm::vec3> values, const Met& met) const {
    const SidesOfPoint found = sides_of_point(voxels_, met.position, met.normal, -1);
    glm::vec3 sum(0.0f);
    for (int axis = 0; axis < 3; ++axis) {
      if (found.weights[axis] > 0.0f) sum += found.weights[axis] * values[size_t(found.sides[axis])];
    }
    return sum;
  }

  const VoxelGrid& voxels_;
  const EmbreeScene& embree_;
  const ContactSides& sides_;
  float near_m_;
};

}  // namespace

glm::vec3 radiosity_by_lamps(const EmbreeScene& embree, glm::vec3 origin, glm::vec3 normal, glm::vec3 albedo,
                             std::uint32_t seed) {
  const std::vector<Light>& lamps = embree.scene().lights;
  if (lamps.empty() || albedo == glm::vec3(0.0f)) return glm::vec3(0.0f);
  // One of them, by a reservoir: each with its share of what all would bring.
  float all = 0.0f, taken = 0.0f;
  glm::vec3 irradiance(0.0f), towards(0.0f);
  const Light* lamp = nullptr;
  for (const Light& candidate : lamps) {
    glm::vec3 way;
    const glm::vec3 e = irradiance_of(to_shared(candidate), origin, normal, way);
    const float weight = level(e);
    if (!(weight > 0.0f)) continue;
    all += weight;
    if (random(seed) * all > weight) continue;
    lamp = &candidate;
    taken = weight;
    irradiance = e;
    towards = way;
  }
  if (lamp == nullptr) return glm::vec3(0.0f);
  const bool sun = lamp->type == Light::Type::directional;
  const float distance = sun ? FAR : glm::length(lamp->position - origin);
  return albedo * irradiance * (all / taken) * embree.passed({origin, towards, distance, seed, {}, {}});
}

std::vector<ContactLight> contact_light(const VoxelGrid& voxels, const EmbreeScene& embree, const ContactSides& sides,
                                        std::span<const ContactPoint> points, int paths) {
  std::vector<ContactLight> lights(points.size());
  const Walk walk(voxels, embree, sides);
  oneapi::tbb::parallel_for(size_t(0), points.size(), [&](size_t i) { lights[i] = walk.from(points[i], paths); });
  return lights;
}

}  // namespace volgi
