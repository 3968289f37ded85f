#include "propagation/light_in/face_light_cpu.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "core/visibility/light_flux.h"
#include "voxel/grid_faces.h"

namespace volgi {

namespace {

/// A ray that has come to a side.
struct Lit {
  glm::ivec3 cell;
  int face;
  glm::vec3 at;     // on the face, cell units
  glm::vec3 power;  // that falls on it [W]
};
struct NumberedLit {
  std::uint64_t number;
  Lit lit;
};

/// By row of texels; rows first, first + step, ... alone.
std::vector<std::vector<Lit>> rows_lit(const LightRays& rays, const GridFaces& faces, const Grid& grid, size_t first,
                                       size_t step) {
  std::vector<std::vector<Lit>> found(rays.rows());
  oneapi::tbb::parallel_for(first, found.size(), step, [&](size_t row) {
    rays.for_each_of_row(row, [&](const LightRay& ray) {
      const glm::vec3 origin = shared::cell_from_world(grid, ray.origin);
      GridFaces::Hit hit;
      if (!faces.meet(origin, ray.direction, ray.seed, hit)) return;
      const glm::vec3 power = ray.power_after(hit.t * grid.cell_size_m);
      if (power != glm::vec3(0.0f)) found[row].push_back({hit.cell, hit.face, origin + hit.t * ray.direction, power});
    });
  });
  return found;
}

/// Along the face's axis on to the surface that the side shows, where that is within the cells on either side.
glm::vec3 on_surface(const shared::Side& side, glm::ivec3 cell, glm::vec3 at) {
  const int axis = side.face >> 1;
  const float along = side.normal[axis];
  if (std::abs(along) < 0.1f) return at;  // hardly a slope's own place
  at[axis] -= std::clamp(shared::height_over_side(side, cell, at) / along, -1.0f, 1.0f);
  return at;
}

FluxSample sample_of(const VoxelGrid& voxels, const Lit& lit) {
  const shared::Side& side = voxels.sides()[shared::side_index(voxels.cell_sides(lit.cell), lit.face)];
  return {shared::world_from_cell(voxels.grid(), on_surface(side, lit.cell, lit.at)), side.normal,
          lit.power * side.albedo};
}

}  // namespace

std::vector<FluxSample> face_light(const Scene& scene, const VoxelGrid& voxels, int texels_on_edge) {
  const LightRays rays(scene, texels_on_edge);
  std::vector<FluxSample> samples;
  for (const auto& row : rows_lit(rays, GridFaces(voxels), voxels.grid(), 0, 1)) {
    for (const Lit& lit : row) samples.push_back(sample_of(voxels, lit));
  }
  return samples;
}

std::vector<NumberedFluxSample> face_light(const Scene& scene, const VoxelGrid& voxels, const RanksOfVolume& ranks,
                                           int texels_on_edge) {
  const LightRays rays(scene, texels_on_edge);
  const auto rank = size_t(ranks.ranks.rank()), count = size_t(ranks.ranks.count());
  const auto rows = rows_lit(rays, GridFaces(voxels, ranks), voxels.grid(), rank, count);
  std::vector<std::vector<NumberedLit>> to(count);
  for (std::uint64_t row = 0; row < rows.size(); ++row) {
    for (std::uint64_t i = 0; i < rows[row].size(); ++i)
      to[size_t(ranks.decomposition.owner(rows[row][i].cell / kLeafCells))].push_back({row << 32 | i, rows[row][i]});
  }
  std::vector<NumberedFluxSample> samples;
  for (const auto& from : exchange_values(ranks.ranks, to)) {
    for (const NumberedLit& n : from) samples.push_back({sample_of(voxels, n.lit), n.number});
  }
  return samples;
}

}  // namespace volgi
