#pragma once
#include <string_view>

#include "reference/metrics.h"

namespace volgi {

/// A mistake without which a picture would fit its reference much better: "flipped vertically", "flipped horizontally",
/// "divided by pi", "times pi" is what to do with the picture. Empty when none of these helps.
/// @param compared  pixels that count; the others are taken to be black in both (a sky that the camera sees).
/// Source: compare.py of the reference images, hints().
std::string_view fit_hint(const Image& ref, const Image& test, const Mask& compared);

}  // namespace volgi
