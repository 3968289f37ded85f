#include "propagation/light_in/gather_rows_cpu.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/hash.h"
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

Met met_by(const VoxelGrid& voxels, const EmbreeScene& embree, const Ray& ray) {
  RayHit hit;
  if (!embree.intersect(ray, hit)) return {};
  const Mesh& mesh = embree.scene().meshes[hit.mesh];
  const glm::uvec3 t = mesh.triangles[hit.triangle];
  const glm::vec3 a = mesh.positions[t.x];
  const glm::vec3 normal = glm::normalize(glm::cross(mesh.positions[t.y] - a, mesh.positions[t.z] - a));
  const glm::vec3 position = ray.origin + hit.distance * ray.direction;
  const glm::vec3 cell = shared::cell_from_world(voxels.grid(), position);
  constexpr float RIM = 0.25f;  // cells: surfaces lie on the grid's own rim
  const bool outside = glm::any(glm::lessThan(cell, glm::vec3(-RIM))) ||
                       glm::any(glm::greaterThan(cell, glm::vec3(voxels.grid().cells) + RIM));
  if (outside) return {};
  const bool front = glm::dot(normal, ray.direction) < 0.0f;
  return {one_of(sides_of_point(voxels, position, front ? normal : -normal, -1), ray.alpha_seed), packed(hit.tint)};
}

}  // namespace

void GatherRows::trace(const VoxelGrid& voxels, const EmbreeScene& embree, std::span<const std::uint32_t> sides,
                       int first, int count) {
  rays_ = count;
  met_.assign(sides.size() * size_t(count), Met{});
  oneapi::tbb::parallel_for(size_t(0), sides.size(), [&](size_t i) {
    const shared::Side& side = voxels.sides()[sides[i]];
    const SideStart start = start_of_side(voxels, embree, side);
    const std::uint32_t place = hash(std::uint32_t(side.cell) * 6u + std::uint32_t(side.face));
    for (int k = 0; k < count; ++k) {
      const std::uint32_t n = place + std::uint32_t(first + k);
      const glm::vec3 way = cosine_direction(side.normal, recurrence_in_square(n));
      met_[i * size_t(count) + size_t(k)] =
          met_by(voxels, embree, {start.origin, way, std::numeric_limits<float>::infinity(), n, start.from, {}});
    }
  });
}

void Gathered::add(std::span<const GatherRows::Met> row, std::span<const glm::vec3> radiosity) {
  for (const Met& met : row) {
    if (met.side == Met::UNKNOWN) continue;
    ++rays;
    if (met.side < 0) continue;
    glm::vec3 b = radiosity[size_t(met.side)];
    if (met.tint != 0xffffff) b *= unpacked(met.tint);
    sum += b;
    const float mean = (b.x + b.y + b.z) / 3.0f;
    squares += mean * mean;
  }
}

float Gathered::scatter() const {
  const glm::vec3 m = mean();
  const float level = (m.x + m.y + m.z) / 3.0f;
  return std::max(squares - float(rays) * level * level, 0.0f);
}

}  // namespace volgi
