#pragma once
#include "reference/metrics.h"

namespace volgi {

/// Structural similarity of two pictures at half size, on the sRGB-encoded luminance of picture · exposure, in an 11x11
/// Gaussian window of sigma 1.5 (Wang et al. 2004, K = 0.01, 0.03), mean over the half-size pixels of which at least
/// three quarters are in the mask. @returns NaN when there are none.
double ssim(const Image& ref, const Image& test, double exposure, const Mask& mask);

}  // namespace volgi
