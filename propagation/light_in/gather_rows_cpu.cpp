#include "propagation/light_in/gather_rows_cpu.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/hash.h"
#include "core/level.h"
#include "propagation/light_in/cosine_direction_internal.h"
#include "propagation/light_in/side_start_internal.h"
#include "voxel/side_search.h"

namespace volgi {
namespace {

using Met = GatherRows::Met;

std::uint32_t packed(glm::vec3 tint) {
  const glm::uvec3 bits(255.0f * glm::clamp(tint, 0.0f, 1.0f) + 0.5f);
  return bits.x | bits.y << 8 | bits.z << 16;
}

glm::vec3 unpacked(std::uint32_t tint) { return glm::vec3(tint & 255u, tint >> 8 & 255u, tint >> 16) / 255.0f; }

float square(float x) { return x * x; }

/// Of the sides that stand for the point, one by their weights: the mean over rays is that of all.
std::int32_t one_of(const SidesOfPoint& found, std::uint32_t seed) {
  float at = float(hash(seed) >> 8) * 0x1p-24f;
  std::int32_t chosen = Met::UNKNOWN;
  for (int axis = 0; axis < 3; ++axis) {
    if (!(found.weights[axis] > 0.0f)) continue;
    chosen = found.sides[axis];
    at -= found.weights[axis];
    if (at < 0.0f) break;
  }
  return chosen;
}

/// @param at  of the surface [cells]; kept where there is none.
Met met_by(const VoxelGrid& voxels, const EmbreeScene& embree, const Ray& ray, glm::vec3& at) {
  RayHit hit;
  if (!embree.intersect(ray, hit)) return {};
  const Mesh& mesh = embree.scene().meshes[hit.mesh];
  const glm::uvec3 t = mesh.triangles[hit.triangle];
  const glm::vec3 a = mesh.positions[t.x];
  const glm::vec3 normal = glm::normalize(glm::cross(mesh.positions[t.y] - a, mesh.positions[t.z] - a));
  const glm::vec3 position = ray.origin + hit.distance * ray.direction;
  const glm::vec3 cell = at = shared::cell_from_world(voxels.grid(), position);
  constexpr float RIM = 0.25f;  // cells: surfaces lie on the grid's own rim
  const bool outside = glm::any(glm::lessThan(cell, glm::vec3(-RIM))) ||
                       glm::any(glm::greaterThan(cell, glm::vec3(voxels.grid().cells) + RIM));
  if (outside) return {};
  const bool front = glm::dot(normal, ray.direction) < 0.0f;
  return {one_of(sides_of_point(voxels, position, front ? normal : -normal, -1), ray.alpha_seed), packed(hit.tint)};
}

/// Rays of one side.
class SideRays {
 public:
  SideRays(const VoxelGrid& voxels, const EmbreeScene& embree, const PassageAim& passages, const shared::Side& side)
      : voxels_(voxels),
        embree_(embree),
        side_(side),
        start_(start_of_side(voxels, embree, side)),
        place_(hash(std::uint32_t(side.cell) * 6u + std::uint32_t(side.face))),
        passages_(passages, shared::cell_from_world(voxels.grid(), start_.origin), side.normal) {}

  bool sees_passages() const { return !passages_.empty(); }

  Met by_cosine(int n) const {
    const std::uint32_t seed = place_ + std::uint32_t(n);
    glm::vec3 at;
    const Met met = met_on(cosine_direction(side_.normal, recurrence_in_square(seed)), seed, at);
    // Through a passage it is another ray's.
    return met.side >= 0 && !passages_.empty() && passages_.crossed(at) > 0 ? Met{} : met;
  }

  GatherRows::Through through(int n, int of, int first) const {
    const std::uint32_t seed = hash(place_ + std::uint32_t(first)) + std::uint32_t(n);
    const PassageAim::From::Ray ray = passages_.ray(n, of, seed);
    if (!(ray.weight > 0.0f)) return {};
    const glm::vec3 from = shared::cell_from_world(voxels_.grid(), start_.origin), to = ray.target - from;
    glm::vec3 at = from;
    const Met met = met_on(glm::normalize(to), seed, at);
    if (met.side == Met::NOTHING || glm::distance(at, from) < glm::length(to)) return {};
    return {met, ray.weight / float(std::max(passages_.crossed(at), 1))};
  }

 private:
  Met met_on(glm::vec3 way, std::uint32_t seed, glm::vec3& at) const {
    return met_by(voxels_, embree_, {start_.origin, way, std::numeric_limits<float>::infinity(), seed, start_.from, {}},
                  at);
  }

  const VoxelGrid& voxels_;
  const EmbreeScene& embree_;
  const shared::Side& side_;
  SideStart start_;
  std::uint32_t place_;
  PassageAim::From passages_;
};

}  // namespace

void GatherRows::trace(const VoxelGrid& voxels, const EmbreeScene& embree, const PassageAim& passages,
                       std::span<const std::uint32_t> sides, int first, int count) {
  rays_ = count;
  rays_through_ = passages.empty() ? 0 : through_of(count);
  met_.assign(sides.size() * size_t(count), Met{});
  through_.assign(sides.size() * size_t(rays_through_), Through{});
  oneapi::tbb::parallel_for(size_t(0), sides.size(), [&](size_t i) {
    const SideRays rays(voxels, embree, passages, voxels.sides()[sides[i]]);
    for (int k = 0; k < count; ++k) met_[i * size_t(count) + size_t(k)] = rays.by_cosine(first + k);
    if (!rays.sees_passages()) return;
    for (int k = 0; k < rays_through_; ++k)
      through_[i * size_t(rays_through_) + size_t(k)] = rays.through(k, rays_through_, first);
  });
}

void Gathered::add(const GatherRows::Row& row, std::span<const glm::vec3> radiosity) {
  const auto brought = [&](const Met& met) {
    const glm::vec3 b = radiosity[size_t(met.side)];
    return met.tint != 0xffffff ? b * unpacked(met.tint) : b;
  };
  for (const Met& met : row.met) {
    if (met.side == Met::UNKNOWN) continue;
    ++rays;
    if (met.side < 0) continue;
    const glm::vec3 b = brought(met);
    sum += b;
    squares += square(level(b));
  }
  for (const GatherRows::Through& t : row.through) {
    if (t.met.side == Met::UNKNOWN) continue;
    ++rays_through;
    if (t.met.side < 0) continue;
    const glm::vec3 b = t.weight * brought(t.met);
    sum_through += b;
    squares_through += square(level(b));
  }
}

float Gathered::scatter() const {
  const auto about_mean = [](glm::vec3 of_sum, float of_squares, int n) {
    return n > 0 ? std::max(of_squares - square(level(of_sum)) / float(n), 0.0f) : 0.0f;
  };
  float scatter = about_mean(sum, squares, rays);
  if (rays_through > 1) {
    const float of_mean =
        about_mean(sum_through, squares_through, rays_through) / (float(rays_through) * float(rays_through - 1));
    scatter += of_mean * float(rays) * float(rays - 1);
  }
  return scatter;
}

}  // namespace volgi
