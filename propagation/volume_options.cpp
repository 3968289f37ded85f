#include "propagation/volume_options.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "core/light_shares.h"
#include "core/log.h"
#include "core/surface.h"
#include "shaders/voxel/white_pockets.shared.h"

namespace volgi {

BounceRules bounce_rules(const VolumeOptions& o, float largest_albedo) {
  if (!carries_sides(o.scheme.scheme)) {
    if (o.bounces)
      throw Error(ExitCode::usage, "--bounces: the papers' schemes cannot tell orders apart; use --iterations");
    if (o.warm_start || o.passes_per_run)
      throw Error(ExitCode::usage, "the papers' schemes start every frame anew: no warm start, no amortised frames");
  }
  if (o.source == VolumeOptions::Source::first_bounce && o.scheme.injection == SchemeOptions::Injection::max)
    throw Error(ExitCode::usage, "gaitatzes.inject=max starts from lights: use --gi volume");
  BounceRules rules;
  rules.bounces = o.bounces;
  // The screen carries one; emission has one order more, whose arrival is then bounce 1 (BounceRules::bounces).
  if (rules.bounces && o.source == VolumeOptions::Source::first_bounce) rules.bounces = std::max(*rules.bounces - 1, 0);
  rules.iterations = o.iterations;
  rules.solver = o.solver;
  rules.warm_start = o.warm_start;
  rules.passes_per_run = o.passes_per_run;
  rules.largest_albedo = largest_albedo;
  return rules;
}

BounceRules bounce_rules(const VolumeOptions& options, const Scene& scene) {
  BounceRules rules = bounce_rules(options, largest_albedo(scene));
  rules.weakest = std::max(float(share_within(scene)), BounceRules::kWeakest);
  return rules;
}

bool lights_by_rays(const Scene& scene, const VolumeOptions& o) {
  if (o.cascade.nested()) return true;
  if (o.first_light != VolumeOptions::FirstLight::automatic) return o.first_light == VolumeOptions::FirstLight::rays;
  size_t triangles = 0;
  for (const Mesh& mesh : scene.meshes) triangles += mesh.triangles.size();
  return triangles <= VolumeOptions::kMostTrianglesOfRays;
}

const Sky* streaming_sky(const Scene& scene, const VolumeOptions& o) {
  const bool carries = o.scheme.scheme == Scheme::ordinates && o.source == VolumeOptions::Source::lights;
  return carries ? scene.sky.get() : nullptr;
}

void refuse_on_gpu(const VolumeOptions& o) {
  if (o.cascade.nested()) throw Error(ExitCode::usage, "--cascades: nested grids are the CPU's; use --backend cpu");
  if (o.scheme.directions.value_or(0) > VolumeOptions::kMaxDirectionsGpu)
    throw Error(ExitCode::over_limit, fmt::format("--directions {}: the GPU takes {}; use --backend cpu",
                                                  *o.scheme.directions, VolumeOptions::kMaxDirectionsGpu));
  if (o.grid_cells > VolumeOptions::kMaxDenseGridCells)
    throw Error(ExitCode::over_limit, fmt::format("--grid {}: the GPU takes {} cells along an axis; use --backend cpu",
                                                  o.grid_cells, VolumeOptions::kMaxDenseGridCells));
  if (o.voxelization.method == VoxelizationMethod::single_pass && o.voxelization.interleave)
    throw Error(ExitCode::usage, "voxel.interleave=1 takes turns at axes, which voxel.method=single_pass has not");
  if (o.first_light == VolumeOptions::FirstLight::faces)
    throw Error(ExitCode::usage, "--first-light faces: the GPU has shadow maps for that; use --backend cpu");
  if (o.scheme.scheme == Scheme::conservative && o.scheme.coarse_start.value_or(false))
    throw Error(ExitCode::usage,
                "conservative.coarse=1: the GPU has no coarse grid; leave it out, or use --backend cpu");
}

void refuse_on_cpu(const VolumeOptions& o) {
  if (o.cascade.nested() && o.scheme.scheme != Scheme::ordinates)
    throw Error(ExitCode::usage, "--cascades: nested grids are for --scheme ordinates");
  if (o.cascade.nested() && o.first_light == VolumeOptions::FirstLight::faces)
    throw Error(ExitCode::usage, "--cascades: light finds nested grids by rays; not with --first-light faces");
  if (o.voxelization.method != VoxelizationMethod::sliced || o.voxelization.interleave)
    throw Error(ExitCode::usage,
                "voxel.method=single_pass, voxel.interleave=1: the CPU slices along three axes; use --backend gpu");
  if (o.scheme.scheme != Scheme::ordinates && o.grid_cells > VolumeOptions::kMaxDenseGridCells)
    throw Error(ExitCode::over_limit,
                fmt::format("--grid {}: more than {} cells along an axis are for --scheme ordinates, the others keep "
                            "light in every cell",
                            o.grid_cells, VolumeOptions::kMaxDenseGridCells));
}

void refuse_of_ranks(const VolumeOptions& o) {
  if (!carries_sides(o.scheme.scheme))
    throw Error(ExitCode::usage,
                "the papers' schemes run as one rank; of several there are --scheme ordinates and "
                "conservative");
  if (o.cascade.nested()) throw Error(ExitCode::usage, "--cascades: nested grids run as one rank");
}

void warn_of_answer(const std::string& scene, const VolumeOptions& o, const BounceReport& report, size_t pocket_cells,
                    size_t cells) {
  const bool all_asked = !o.bounces && !o.iterations && !o.passes_per_run && carries_sides(o.scheme.scheme);
  if (all_asked && !report.converged) {
    const auto most = [](glm::vec3 v) { return double(std::max({v.x, v.y, v.z})); };
    warn_of_wrong_result(
        fmt::format("{}: the volume's bounces have not come to their end after {} orders, {:.3g} W of {:.3g} W are "
                    "left: the picture is not right; --set solver.cg=plain or --bounces N may do better",
                    scene, report.orders, most(report.left), most(report.sent)));
  }
  constexpr size_t LARGE = 20;  // a twentieth of all cells is a room
  if (pocket_cells * LARGE > cells) {
    warn_once(
        fmt::format("{}: a closed place whose surfaces all reflect {:g} or more keeps its light for ever; its "
                    "albedo counts as {:g} in the volume",
                    scene, double(WHITE_ALBEDO), double(MAX_POCKET_ALBEDO)));
  }
}

void refuse_above_limit(const VolumeOptions& o, size_t expected, const char* where) {
  if (!o.memory_limit || expected <= *o.memory_limit) return;
  throw Error(ExitCode::over_limit,
              fmt::format("--grid {}: the volume needs about {:.1f} MiB on the {}, --memory-limit allows {:.1f}; use a "
                          "smaller --grid",
                          o.grid_cells, double(expected) / 1048576.0, where, double(*o.memory_limit) / 1048576.0));
}

}  // namespace volgi
