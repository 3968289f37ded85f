#pragma once
#include "reference/metrics.h"

namespace volgi {

/// Signed relative error (test - ref) / (ref + 0.1·mean of ref), channels averaged, as display values: white where
/// equal, red where the test is too bright, blue where too dark, saturated at ±50 %; pixels outside the mask are
/// dimmed, those that are not finite magenta. Of the pictures' size.
Image error_colors(const Image& ref, const Image& test, const Mask& mask);

/// Colour bar of error_colors() with its legend, 32 pixels high.
/// @param width  [pixels], at least 128.
Image error_scale(int width);

/// error_colors(), enlarged to at least 256 pixels a side, with error_scale() underneath.
Image error_map(const Image& ref, const Image& test, const Mask& mask);

}  // namespace volgi
