#pragma once
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "core/scene.h"
#include "propagation/volume_options.h"

namespace volgi {

/// How one stage's two answers compare: |GPU - CPU| over the stage's scale, per voxel or side.
struct CrosscheckRow {
  std::string stage;
  std::string scale;  // what differences are divided by, in words
  size_t compared = 0;
  double maximum = 0.0;
  double percentile_999 = 0.0;
  glm::ivec3 worst_cell{0};  // where the maximum is
  double limit = 0.0;
  /// Rounding decides at points on the boundary of two columns, and at faces whose power `conservative` clamps: then
  /// 99.9 % must be within the limit.
  bool ties = false;
  bool passed() const { return (ties ? percentile_999 : maximum) <= limit; }
};

/// Compares the GPU with its CPU twin stage by stage, each stage of the one fed with the other's previous stage:
/// blocked faces, coverage, normals, albedo, area, emission; cells' occupancy; injected flux; power received (the
/// papers' schemes: radiance) after 1, 8 and 64 passes; irradiance; radiance in free space. Needs a current
/// gl::Context.
/// @param options  grid and scheme; orders one after another, no coarse part, cold start, whatever it asks for.
/// @throws Error as Frame and VolumeCpu do.
std::vector<CrosscheckRow> crosscheck(const Scene& scene, const VolumeOptions& options,
                                      const std::vector<int>& passes = {1, 8, 64});

}  // namespace volgi
