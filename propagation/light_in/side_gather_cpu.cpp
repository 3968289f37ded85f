#include "propagation/light_in/side_gather_cpu.h"

#include <algorithm>
#include <cassert>
#include <glm/gtc/constants.hpp>
#include <limits>

#include "core/octahedral.h"
#include "core/surface.h"
#include "propagation/side_loops.h"
#include "shaders/shared/disk_to_point.shared.h"

namespace volgi {

namespace {

using shared::Side;
using shared::VirtualLight;

constexpr float kSimilarNormalCosine = 0.70710678f;  // within 45 degrees
// The slicing passes round vertices to half a step, which moves a surface along the axis that its normal is nearest to
// by 3/2 steps at most. Nearer to the surface than that, a cell's centre may lie on it or behind it.
constexpr float kRounded = 2.0f / float(SLICE_STEPS);  // cells

/// Where rays of a side start.
struct Start {
  glm::vec3 position;  // on the surface
  glm::vec3 origin;    // of rays: beside the surface, where the cell is
  TriangleIndex from;
};

/// What the cell's line through `middle` (world, in the plane of the cell's centre) towards the side's face meets
/// within one cell, if it faces as the side does. What lies before is free, so that rays from there start on the cell's
/// side of every wall, however thin.
bool meets(const EmbreeScene& embree, const Side& side, float depth_from_centre, float cell_size_m, glm::vec3 middle,
           Start& start) {
  const glm::vec3 along(shared::face_step(side.face));
  const float back = std::abs(depth_from_centre) < kRounded ? kRounded : 0.0f;
  const glm::vec3 origin = middle - along * (back * cell_size_m);
  RayHit hit;
  if (!embree.intersect(origin, along, (1.0f + kRounded + back) * cell_size_m, 0, hit)) return false;
  const Scene& scene = embree.scene();
  const Mesh& mesh = scene.meshes[hit.mesh];
  const glm::uvec3 t = mesh.triangles[hit.triangle];
  const glm::vec3 a = mesh.positions[t.x];
  const glm::vec3 across = glm::cross(mesh.positions[t.y] - a, mesh.positions[t.z] - a);
  const float facing = std::abs(glm::dot(across, side.normal));
  if (!(facing >= kSimilarNormalCosine * glm::length(across))) return false;
  start.position = origin + along * hit.distance;
  start.origin = embree.leaving_point(start.position, along, hit.distance);
  start.from = hit.index();
  return true;
}

bool free_between(const EmbreeScene& embree, glm::vec3 a, glm::vec3 b) {
  const float distance = glm::distance(a, b);
  return distance == 0.0f || !embree.occluded({a, (b - a) / distance, distance, 0, {}, {}});
}

bool reached(const EmbreeScene& embree, glm::vec3 from, glm::vec3 corner, glm::vec3 to) {
  return free_between(embree, from, corner) && free_between(embree, corner, to);
}

/// The surface on the line through the cell's centre; where an edge is near, on one of the eight lines around it that
/// coverage is counted on (docs/theory.md#voxelization) and that steps in their plane reach. Where that meets nothing
/// (surfaces that end between the lines once they are rounded), rays start in the cell's centre.
Start start_of(const VoxelGrid& voxels, const EmbreeScene& embree, const Side& side) {
  const float h = voxels.grid().cell_size_m;
  const glm::vec3 cell = glm::vec3(shared::cell_coord(voxels.grid(), side.cell)) + 0.5f;
  const glm::vec3 centre = shared::world_from_cell(voxels.grid(), cell);
  const int axis = shared::face_axis(side.face);
  const float depth = side.depth - cell[axis];
  Start start;
  if (meets(embree, side, depth, h, centre, start)) return start;
  const int axis_b = shared::axis_b(axis), axis_c = shared::axis_c(axis);
  for (int k : {1, 3, 5, 7, 0, 2, 6, 8}) {
    const int column = k % 3 - 1, row = k / 3 - 1;
    glm::vec3 middle = centre;
    middle[axis_b] += float(column) * h / 3.0f;
    middle[axis_c] += float(row) * h / 3.0f;
    glm::vec3 corner_b = centre, corner_c = centre;
    corner_b[axis_b] = middle[axis_b];
    corner_c[axis_c] = middle[axis_c];
    if (!reached(embree, centre, corner_b, middle) && !reached(embree, centre, corner_c, middle)) continue;
    if (meets(embree, side, depth, h, middle, start)) return start;
  }
  glm::vec3 point = cell;
  const float next = point[axis] + float(shared::face_sign(side.face));
  point[axis] = std::clamp(side.depth, std::min(point[axis], next), std::max(point[axis], next));
  return {shared::world_from_cell(voxels.grid(), point), centre, {}};
}

/// A light or a sub-light of one, as a side sees it.
struct Disk {
  glm::vec3 position, normal, flux;
  float area_m2;
};

constexpr float FAR = std::numeric_limits<float>::infinity();

/// @param end  of rays to the light: beside its surface.
glm::vec3 irradiance_of(const EmbreeScene& embree, const Side& side, const Start& start, const Disk& light,
                        glm::vec3 end, std::uint32_t seed) {
  const glm::vec3 to_light = light.position - start.position;
  const float along_side = glm::dot(to_light, side.normal), along_light = -glm::dot(to_light, light.normal);
  const bool dark = light.flux == glm::vec3(0.0f);
  if (dark || !(along_side > 0.0f) || !(along_light > 0.0f)) return glm::vec3(0.0f);
  const glm::vec3 way = end - start.origin;
  const float distance = glm::length(way);
  if (distance > 0.0f && embree.occluded({start.origin, way / distance, distance, seed, start.from, {}})) {
    return glm::vec3(0.0f);
  }
  const float squared = glm::dot(to_light, to_light);
  const float facing = -glm::dot(light.normal, side.normal);
  return light.flux * shared::disk_to_point(along_light, along_side, facing, squared, light.area_m2);
}

glm::vec3 irradiance_of_sublight(const EmbreeScene& embree, const Side& side, const Start& start,
                                 const shared::SubLight& sublight, std::uint32_t seed) {
  const Disk disk{sublight.position, octahedral_decode(sublight.normal), sublight.flux, sublight.area_m2};
  return irradiance_of(embree, side, start, disk, embree.leaving_point(disk.position, -disk.normal, FAR), seed);
}

/// Share of a disk's light at a point that comes from itself and not from what it consists of.
float far_share_at(glm::vec3 point, glm::vec3 position, float area_m2, float zone) {
  const glm::vec3 way = position - point;
  return shared::far_share(shared::disk_nearness(glm::dot(way, way), area_m2), zone);
}

/// Of a light's sub-lights: its coarse ones, and nearer by half the fine ones of those. As near_lights.comp.glsl has
/// it.
glm::vec3 irradiance_of_sublights(const EmbreeScene& embree, const Side& side, const Start& start,
                                  std::span<const shared::SubLight> sublights, float zone, std::uint32_t seed) {
  constexpr size_t FINE_PER_COARSE = FINE_SUBLIGHTS / COARSE_SUBLIGHTS;
  glm::vec3 sum(0.0f);
  for (size_t coarse = 0; coarse < COARSE_SUBLIGHTS; ++coarse) {
    const shared::SubLight& whole = sublights[coarse];
    const float far = far_share_at(start.position, whole.position, whole.area_m2, zone);
    if (far > 0.0f) sum += far * irradiance_of_sublight(embree, side, start, whole, seed);
    if (far >= 1.0f) continue;
    for (size_t k = 0; k < FINE_PER_COARSE; ++k) {
      const shared::SubLight& part = sublights[COARSE_SUBLIGHTS + coarse * FINE_PER_COARSE + k];
      sum += (1.0f - far) * irradiance_of_sublight(embree, side, start, part, seed + std::uint32_t(k));
    }
  }
  return sum;
}

/// What a light has itself and not its sub-lights.
float share_of_light(const VirtualLightsForSides& from, size_t light, glm::vec3 point) {
  if (from.sublights.empty()) return 1.0f;
  return far_share_at(point, from.lights[light].position, from.lights[light].area_m2, from.near_zone);
}

}  // namespace

int automatic_stride(size_t sides, size_t lights) {
  constexpr size_t kRays = size_t(1) << 19;
  constexpr size_t kLargest = 32;
  return int(std::clamp((sides * lights + kRays - 1) / kRays, size_t(1), kLargest));
}

std::vector<glm::vec4> side_gather(const VoxelGrid& voxels, const EmbreeScene& embree,
                                   const VirtualLightsForSides& from, size_t first, size_t end, int stride) {
  assert(stride >= 1 && end <= from.lights.size());
  assert(from.sublights.empty() || from.sublights.size() >= from.lights.size() * SUBLIGHTS_PER_LIGHT);
  std::vector<glm::vec3> ends(from.lights.size());
  for (size_t i = first; i < end; ++i)
    ends[i] = embree.leaving_point(from.lights[i].position, -from.lights[i].normal, FAR);
  std::vector<glm::vec4> irradiance(voxels.side_count());
  for_each_side(irradiance.size(), [&](size_t i) {
    const Side& side = voxels.sides()[i];
    const glm::ivec3 cell = shared::cell_coord(voxels.grid(), side.cell);
    const Start start = start_of(voxels, embree, side);
    const auto seed_of = [&](size_t k) { return std::uint32_t(i) * 2654435769u + std::uint32_t(k); };
    glm::vec3 far(0.0f), near(0.0f);
    for (auto k = first + size_t(first_light_of_side(cell, side.face, stride)); k < end; k += size_t(stride)) {
      const VirtualLight& light = from.lights[k];
      const float share = share_of_light(from, k, start.position);
      if (share <= 0.0f) continue;
      // Peaks near a light are its sub-lights'.
      const float spread_m2 = from.sublights.empty() ? std::min(float(stride - 1) * light.area_m2, side.area_m2) : 0.0f;
      const float area_m2 = light.area_m2 + spread_m2;
      far += share * irradiance_of(embree, side, start, {light.position, light.normal, light.flux, area_m2}, ends[k],
                                   seed_of(k));
    }
    for (size_t k = first; k < end && !from.sublights.empty(); ++k) {
      const float share = 1.0f - share_of_light(from, k, start.position);
      if (share <= 0.0f) continue;
      const std::span<const shared::SubLight> sublights(&from.sublights[k * SUBLIGHTS_PER_LIGHT], SUBLIGHTS_PER_LIGHT);
      near += share * irradiance_of_sublights(embree, side, start, sublights, from.near_zone, seed_of(k));
    }
    irradiance[i] = glm::vec4(far * float(stride) + near, 0.0f);
  });
  return irradiance;
}

std::vector<glm::vec4> reflected_flux(const VoxelGrid& voxels, std::span<const glm::vec4> irradiance) {
  assert(irradiance.size() == voxels.side_count());
  std::vector<glm::vec4> flux(irradiance.size());
  for_each_side(flux.size(), [&](size_t i) {
    const Side& side = voxels.sides()[i];
    flux[i] = glm::vec4(glm::vec3(irradiance[i]) * side.albedo * side.area_m2, 0.0f);
  });
  return flux;
}

SideFlux flux_after_first_bounce(const VoxelGrid& voxels, const EmbreeScene& embree, const VirtualLightsForSides& from,
                                 bool emission_apart, std::optional<int> stride) {
  const size_t all = from.lights.size(), reflected = emission_apart ? size_t(from.reflected) : all;
  const int step = stride.value_or(automatic_stride(voxels.side_count(), all));
  const auto brought_by = [&](size_t first, size_t end) {
    return reflected_flux(voxels, side_gather(voxels, embree, from, first, end, step));
  };
  SideFlux flux;
  flux.emitted.assign(voxels.side_count(), glm::vec4(0.0f));
  flux.punctual = brought_by(0, reflected);
  flux.emits = reflected < all;
  if (flux.emits) flux.emitted = brought_by(reflected, all);
  return flux;
}

}  // namespace volgi
