#include "voxel/cell_volumes.h"

namespace volgi {

openvdb::math::Transform::Ptr world_from_index(const Grid& grid, glm::dvec3 world_origin) {
  auto transform = openvdb::math::Transform::createLinearTransform(double(grid.cell_size_m));
  const glm::dvec3 centre_of_first = world_origin + glm::dvec3(grid.origin) + 0.5 * double(grid.cell_size_m);
  transform->postTranslate({centre_of_first.x, centre_of_first.y, centre_of_first.z});
  return transform;
}

CellVolumes empty_cell_volumes(const Grid& grid, glm::dvec3 world_origin) {
  const openvdb::math::Transform::Ptr transform = world_from_index(grid, world_origin);
  const openvdb::Vec3s zero(0.0f);
  CellVolumes out{openvdb::FloatGrid::create(0.0f), openvdb::Vec3SGrid::create(zero), openvdb::Vec3SGrid::create(zero),
                  openvdb::Vec3SGrid::create(zero)};
  out.occupancy->setTransform(transform->copy());
  out.albedo->setTransform(transform->copy());
  out.normal->setTransform(transform->copy());
  out.emission->setTransform(transform->copy());
  return out;
}

}  // namespace volgi
