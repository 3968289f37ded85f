#include "propagation/radiance_volume.h"

#include <openvdb/openvdb.h>
#include <openvdb/tools/ValueTransformer.h>

#include <cassert>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace volgi {

const char* sh_grid_name(int coefficient) {
  static constexpr const char* kNames[] = {"sh_00",  "sh_1m1", "sh_10", "sh_11", "sh_2m2",
                                           "sh_2m1", "sh_20",  "sh_21", "sh_22"};
  assert(coefficient >= 0 && coefficient < 9);
  return kNames[coefficient];
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
