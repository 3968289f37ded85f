#pragma once
#include "core/image.h"

namespace volgi {

/// Stops that show a picture at middle brightness: 0.18 over the geometric mean of its luminances, of those between the
/// 5th and the 95th percentile of what is not black. Rounded to 0.01, so that the printed number makes the same
/// picture; 0 for a black one. Scales with the light exactly: the same picture whatever unit its lamps are in.
float automatic_exposure_ev(const Image& image);

}  // namespace volgi
