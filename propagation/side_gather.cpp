#include "propagation/side_gather.h"

#include <algorithm>
#include <cassert>
#include <glm/gtc/constants.hpp>

#include "core/surface.h"
#include "propagation/side_loops.h"

namespace volgi {

namespace {

using shared::Side;
using shared::VirtualLight;

constexpr float kLikeNormals = 0.70710678f;  // within 45 degrees
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
  if (!(facing >= kLikeNormals * glm::length(across))) return false;
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

/// @param end      of rays to the light: beside its surface.
/// @param area_m2  that the light stands for here.
glm::vec3 irradiance_of(const EmbreeScene& embree, const Side& side, const Start& start, const VirtualLight& light,
                        glm::vec3 end, float area_m2, std::uint32_t seed) {
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
  const float cosines = along_side * along_light / squared;
  return light.flux * (cosines / (glm::pi<float>() * squared + area_m2));
}

}  // namespace

int automatic_stride(size_t sides, size_t lights) {
  constexpr size_t kRays = size_t(1) << 19;
  constexpr size_t kLargest = 32;
  return int(std::clamp((sides * lights + kRays - 1) / kRays, size_t(1), kLargest));
}

std::vector<glm::vec4> side_gather(const VoxelGrid& voxels, const EmbreeScene& embree,
                                   std::span<const VirtualLight> lights, int stride) {
  assert(stride >= 1);
  std::vector<glm::vec3> ends(lights.size());
  for (size_t i = 0; i < lights.size(); ++i) {
    ends[i] = embree.leaving_point(lights[i].position, -lights[i].normal, std::numeric_limits<float>::infinity());
  }
  std::vector<glm::vec4> irradiance(voxels.side_count());
  for_each_side(irradiance.size(), [&](size_t i) {
    const Side& side = voxels.sides()[i];
    const glm::ivec3 cell = shared::cell_coord(voxels.grid(), side.cell);
    const Start start = start_of(voxels, embree, side);
    glm::vec3 sum(0.0f);
    for (auto k = size_t(first_light_of_side(cell, side.face, stride)); k < lights.size(); k += size_t(stride)) {
      const std::uint32_t seed = std::uint32_t(i) * 2654435769u + std::uint32_t(k);
      const float area_m2 = std::min(float(stride) * lights[k].area_m2, lights[k].area_m2 + side.area_m2);
      sum += irradiance_of(embree, side, start, lights[k], ends[k], area_m2, seed);
    }
    irradiance[i] = glm::vec4(sum * float(stride), 0.0f);
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

}  // namespace volgi
