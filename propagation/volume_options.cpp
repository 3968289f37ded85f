#include "propagation/volume_options.h"

#include "core/error.h"

namespace volgi {

BounceRules bounce_rules(const VolumeOptions& o, float largest_albedo) {
  if (!carries_sides(o.scheme.scheme)) {
    if (o.bounces)
      throw Error(ExitCode::usage, "--bounces: the papers' schemes cannot tell orders apart; use --iterations");
    if (o.warm_start || o.passes_a_run)
      throw Error(ExitCode::usage, "the papers' schemes start every frame anew: no warm start, no amortised frames");
  }
  BounceRules rules;
  rules.bounces = o.bounces;
  rules.iterations = o.iterations;
  rules.solver = o.solver;
  rules.warm_start = o.warm_start;
  rules.passes_a_run = o.passes_a_run;
  rules.largest_albedo = largest_albedo;
  return rules;
}

}  // namespace volgi
