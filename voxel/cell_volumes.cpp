#include "voxel/cell_volumes.h"

namespace volgi {

openvdb::math::Transform::Ptr world_from_index(const Grid& grid, glm::dvec3 world_origin) {
  auto transform = openvdb::math::Transform::createLinearTransform(double(grid.cell_size_m));
  const glm::dvec3 centre_of_first = world_origin + glm::dvec3(grid.origin) + 0.5 * double(grid.cell_size_m);
  transform->postTranslate({centre_of_first.x, centre_of_first.y, centre_of_first.z});
  return transform;
}

}  // namespace volgi
