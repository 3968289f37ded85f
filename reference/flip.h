#pragma once
#include <optional>
#include <vector>

#include "core/image.h"
#include "reference/metrics.h"

namespace volgi {

/// How different two pictures look to somebody who flips between them: 0 alike ... 1, by pixel.
struct FlipMap {
  std::vector<float> values;
  int exposures = 1;  // of HDR: pictures that were compared, from `start_ev` to `stop_ev`
  double start_ev = 0.0, stop_ev = 0.0;

  /// Over pixels where the mask is not 0.
  double mean(const Mask& mask) const;
};

struct FlipOptions {
  /// Of the eye: 3840 pixels on 0.7 m of screen, seen from 0.7 m, as in the paper.
  double pixels_per_degree = 67.0206;
};

/// LDR-FLIP of two pictures for a screen, linear RGB in [0, 1]. Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström
/// and Fairchild 2020, "FLIP: A Difference Evaluator for Alternating Images", sections 4 and 5. Cost: some 300
/// operations a pixel at the default. @param reference, test  of one size.
FlipMap flip_ldr(const Image& reference, const Image& test, const FlipOptions& options = {});

/// HDR-FLIP: the largest LDR-FLIP over exposures that the reference asks for, tone mapped after ACES. Andersson,
/// Nilsson, Shirley and Akenine-Möller 2021, "Visualizing Errors in Rendered High Dynamic Range Images". We depart: the
/// median that sets the longest exposure is that of pixels that are not black. Negative and non-finite values count as
/// black.
/// @return nothing where the reference is black.
std::optional<FlipMap> flip_hdr(const Image& reference, const Image& test, const FlipOptions& options = {});

}  // namespace volgi
