#include "voxel/cell_volumes.h"

#include <openvdb/openvdb.h>

namespace volgi {

vdb::TransformPtr world_from_index(const Grid& grid, glm::dvec3 world_origin) {
  auto transform = openvdb::math::Transform::createLinearTransform(double(grid.cell_size_m));
  const glm::dvec3 centre_of_first = world_origin + glm::dvec3(grid.origin) + 0.5 * double(grid.cell_size_m);
  transform->postTranslate({centre_of_first.x, centre_of_first.y, centre_of_first.z});
  return transform;
}

CellVolumes empty_cell_volumes(const Grid& grid, glm::dvec3 world_origin) {
  const vdb::TransformPtr transform = world_from_index(grid, world_origin);
  CellVolumes out{vdb::make_float_grid(), vdb::make_vec3s_grid(), vdb::make_vec3s_grid(), vdb::make_vec3s_grid()};
  out.occupancy->setTransform(transform->copy());
  out.albedo->setTransform(transform->copy());
  out.normal->setTransform(transform->copy());
  out.emission->setTransform(transform->copy());
  return out;
}

}  // namespace volgi
