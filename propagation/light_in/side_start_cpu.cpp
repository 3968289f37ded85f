#include "propagation/light_in/side_start_internal.h"

#include <algorithm>

#include "core/surface.h"
#include "propagation/side_loops.h"

namespace volgi {

namespace {

using shared::Side;

// The slicing passes round vertices to half a step, which moves a surface along the axis that its normal is nearest to
// by 3/2 steps at most. Nearer to the surface than that, a cell's centre may lie on it or behind it.
constexpr float kRounded = 2.0f / float(SLICE_STEPS);  // cells

/// What the cell's line through `middle` (world, in the plane of the cell's centre) towards the side's face meets
/// within one cell, if it faces as the side does. What lies before is free, so that rays from there start on the cell's
/// side of every wall, however thin.
bool meets(const EmbreeScene& embree, const Side& side, float depth_from_centre, float cell_size_m, glm::vec3 middle,
           SideStart& start) {
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
  if (!(facing >= SIMILAR_NORMAL_COSINE * glm::length(across))) return false;
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

/// Middle of what the cell's other sides leave of it in the plane of the side's face, cell units; those of the side's
/// own surface leave all. As shaders/voxel/side_middle.glsl has it.
glm::vec3 middle_of(const VoxelGrid& voxels, const Side& side, glm::ivec3 cell) {
  const glm::uvec2 cell_sides = voxels.cell_sides(cell);
  glm::vec3 low(cell), high = low + 1.0f;
  for (int face = 0; face < 6; ++face) {
    if (!shared::has_side(cell_sides, face)) continue;
    const Side& other = voxels.sides()[shared::side_index(cell_sides, face)];
    if (glm::dot(other.normal, side.normal) >= SIMILAR_NORMAL_COSINE) continue;
    (shared::face_sign(face) < 0 ? low : high)[shared::face_axis(face)] = other.depth;
  }
  glm::vec3 middle = glm::vec3(cell) + 0.5f;
  for (const int axis : {shared::axis_b(shared::face_axis(side.face)), shared::axis_c(shared::face_axis(side.face))}) {
    if (low[axis] < high[axis]) middle[axis] = 0.5f * (low[axis] + high[axis]);
  }
  return middle;
}

}  // namespace

SideStart start_of_side(const VoxelGrid& voxels, const EmbreeScene& embree, const Side& side) {
  const float h = voxels.grid().cell_size_m;
  const glm::ivec3 own = shared::cell_coord(voxels.grid(), side.cell);
  const glm::vec3 cell = glm::vec3(own) + 0.5f;
  const glm::vec3 centre = shared::world_from_cell(voxels.grid(), cell);
  const int axis = shared::face_axis(side.face);
  const float depth = side.depth - cell[axis];
  SideStart start;
  const glm::vec3 middle_of_cell = shared::world_from_cell(voxels.grid(), middle_of(voxels, side, own));
  if (meets(embree, side, depth, h, middle_of_cell, start)) return start;
  if (middle_of_cell != centre && meets(embree, side, depth, h, centre, start)) return start;
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

}  // namespace volgi
