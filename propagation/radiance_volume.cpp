#include "propagation/radiance_volume.h"

#include <openvdb/openvdb.h>
#include <openvdb/tools/ValueTransformer.h>

#include <cassert>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "voxel/volume_field.h"

namespace volgi {

const char* sh_grid_name(int coefficient) {
  assert(coefficient >= 0 && size_t(coefficient) < kBandNames.size());
  return kBandNames[size_t(coefficient)];
}

vdb::Vec3SGridPtr fluence(const RadianceVolume& radiance) {
  vdb::Vec3SGridPtr fluence = vdb::copy(*radiance.sh.front());
  fluence->setName("fluence");
  const float factor = 2.0f * std::sqrt(glm::pi<float>());
  openvdb::tools::foreach (fluence->beginValueOn(),
                           [factor](const openvdb::Vec3SGrid::ValueOnIter& value) { value.setValue(factor * *value); });
  return fluence;
}

}  // namespace volgi
