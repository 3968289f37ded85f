#pragma once
#include <cstddef>
#include <glm/glm.hpp>
#include <optional>
#include <string>

#include "core/scene.h"
#include "propagation/bounce_rules.h"
#include "propagation/scheme.h"
#include "voxel/cascade.h"
#include "voxel/grid.h"
#include "voxel/voxelization_options.h"

namespace volgi {

class Ranks;

/// Options of a volume, on either backend.
struct VolumeOptions {
  int grid_cells = 32;               // along the longest axis, 1 ... kMaxGridCells
  glm::vec3 grid_shift_cells{0.0f};  // for tests (voxel/grid.h)
  bool grid_jitter = false;          // of pictures that are averaged each has its grid elsewhere; on the CPU
  std::optional<GridBox> grid_box;   // what the grid lies around; none: the scene
  CascadeOptions cascade;            // nested grids, inside of that one; of `ordinates` on the CPU
  SchemeOptions scheme;
  VoxelizationOptions voxelization;  // on the GPU
  std::optional<int> bounces;        // BounceRules
  std::optional<int> iterations;     // BounceRules; of the papers' schemes, kPulseIterations unless given
  BounceRules::Solver solver = BounceRules::Solver::automatic;
  std::optional<int>
      side_rays;  // of virtual lights, on the CPU (light_in/reflected_flux_cpu.h); none: automatic_rays()
  /// Of sides that pixels read, a last bounce between triangles, on the CPU with `ordinates`
  /// (light_in/final_gather_cpu.h); 0: none.
  int gather_rays = 0;
  bool warm_start = false;
  std::optional<int> passes_per_run;
  /// What the flux that it is given stands for. lights: what lit and emissive surfaces send, and it carries all of the
  /// rest. first_bounce: what sides reflect of virtual lights, where the screen carries the first bounce of punctual
  /// light and the arrival of emission; what is left is bounces 2 ... N of punctual light and 1 ... N of emission
  /// (docs/theory.md#composition).
  enum class Source { lights, first_bounce } source = Source::lights;
  /// By what the light of lamps finds the sides that it falls on, on the CPU: rays through all triangles, in Embree's
  /// tree of them, or the grid's own faces (light_in/face_light_cpu.h). automatic: rays, up to kMostTrianglesOfRays.
  enum class FirstLight { automatic, rays, faces } first_light = FirstLight::automatic;
  /// That hold the volume together, on the CPU; null: there is one.
  const Ranks* ranks = nullptr;
  /// Refused above it [bytes]; none: no limit.
  std::optional<size_t> memory_limit;

  static constexpr int kMaxGridCells = 1024;
  /// Of the GPU, where which faces surfaces cross is decided in double precision (shaders/voxel/lattice.glsl), and of
  /// schemes that keep light in every cell.
  static constexpr int kMaxDenseGridCells = 256;
  static constexpr int kMaxDirectionsGpu = 128;
  /// Of which Embree's tree takes some 2 GiB (docs/results/mpi.md).
  static constexpr size_t kMostTrianglesOfRays = size_t(1) << 24;
  static constexpr int kPulseIterations = 64;  // Gaitatzes 2010, table 1, "room"
};

/// The solver's rules for a scene. @throws Error(usage) for combinations that make no sense, in words of the command
/// line.
BounceRules bounce_rules(const VolumeOptions& options, float largest_albedo);
BounceRules bounce_rules(const VolumeOptions& options, const Scene& scene);

/// Whether the light of lamps finds its sides by rays (VolumeOptions::first_light).
bool lights_by_rays(const Scene& scene, const VolumeOptions& options);

/// The sky whose light streams into the volume: of `ordinates` alone, and not after a first bounce on the screen, which
/// has it. Null: none.
const Sky* streaming_sky(const Scene& scene, const VolumeOptions& options);

/// @throws Error(usage) for what the other backend alone can do, and for what neither can; Error(over_limit) for more
/// cells than it takes.
void refuse_on_gpu(const VolumeOptions& options);
void refuse_on_cpu(const VolumeOptions& options);
/// @throws Error(usage) for what several ranks cannot do together.
void refuse_of_ranks(const VolumeOptions& options);

/// @throws Error(over_limit) naming both figures when `expected` exceeds options.memory_limit. @param where  "CPU",
/// "GPU".
void refuse_above_limit(const VolumeOptions& options, size_t expected, const char* where);

/// Says on stderr what is wrong with a finished answer: bounces that have not come to their end although all were asked
/// for, and a closed place of white surfaces that is more than a pocket (voxel/white_pockets.h).
/// @param pocket_cells  of the grid's `cells`.
void warn_of_answer(const std::string& scene, const VolumeOptions& options, const BounceReport& report,
                    size_t pocket_cells, size_t cells);

}  // namespace volgi
