#pragma once
#include <cstddef>
#include <glm/glm.hpp>
#include <optional>

#include "propagation/bounce_rules.h"
#include "propagation/scheme.h"

namespace volgi {

/// What a volume is asked for, on either backend.
struct VolumeOptions {
  int grid_cells = 32;               // along the longest axis, 1 ... 256
  glm::vec3 grid_shift_cells{0.0f};  // for tests (voxel/grid.h)
  SchemeOptions scheme;
  std::optional<int> bounces;     // BounceRules
  std::optional<int> iterations;  // BounceRules; of the papers' schemes, kPulseIterations unless given
  BounceRules::Solver solver = BounceRules::Solver::automatic;
  bool warm_start = false;
  std::optional<int> passes_a_run;
  /// What the volume starts from. lights: direct light, and it carries all of the rest. first_bounce: the irradiance of
  /// virtual lights at its sides, where the screen carries the first bounce of punctual light and the arrival of
  /// emission; what is left is bounces 2 ... N of punctual light and 1 ... N of emission (docs/theory.md#composition).
  enum class Source { lights, first_bounce } source = Source::lights;
  // Of first_bounce (core/visibility/virtual_lights_cpu.h, propagation/side_gather.h):
  int virtual_lights = 1024;                // at most kMostVirtualLights
  int virtual_light_candidates = 4;         // times as many to choose from; 1: as they come
  std::optional<int> virtual_light_stride;  // each side takes every so many of them; none: automatic_stride()
  static constexpr int kMostVirtualLights = 65536;
  /// Refused above it [bytes]; none: no limit.
  std::optional<size_t> memory_limit;

  static constexpr int kMostGridCells = 256;
  static constexpr int kPulseIterations = 64;  // Gaitatzes 2010, table 1, "room"
};

/// The solver's rules for a scene. @throws Error(usage) for combinations that make no sense, in words of the command
/// line.
BounceRules bounce_rules(const VolumeOptions& options, float largest_albedo);

/// @throws Error(usage) for what only the CPU can do.
void refuse_on_gpu(const VolumeOptions& options);

/// @throws Error(over_limit) naming both figures when `expected` exceeds options.memory_limit. @param where  "CPU",
/// "GPU".
void refuse_above_limit(const VolumeOptions& options, size_t expected, const char* where);

}  // namespace volgi
