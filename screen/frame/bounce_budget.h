#pragma once

namespace volgi::screen {

/// Who computes which part of every light path, so that a composed picture counts each exactly once. Punctual light's
/// direct part is always the screen's (pass "screen/base/direct"), and so is emission seen by the camera.
struct BounceBudget {
  enum class Carrier { nobody, virtual_lights, volume };
  Carrier emission_arrival = Carrier::nobody;  // light straight from emissive surfaces: bounce 0, direct
  Carrier first_bounce = Carrier::nobody;
  Carrier higher_bounces = Carrier::nobody;
};

/// Techniques that --gi can name. `vpl`, `negative` and `val` are first-order: of emissive surfaces they carry the
/// arrival, of punctual lights the first reflection, and nothing after it. `hybrid` adds the volume's bounces to those
/// of `val`.
enum class GiMode { none, volume, vpl, negative, val, hybrid };

inline BounceBudget bounce_budget(GiMode mode) {
  using Carrier = BounceBudget::Carrier;
  switch (mode) {
    case GiMode::none:
      return {Carrier::nobody, Carrier::nobody, Carrier::nobody};
    case GiMode::volume:
      return {Carrier::volume, Carrier::volume, Carrier::volume};
    case GiMode::hybrid:
      return {Carrier::virtual_lights, Carrier::virtual_lights, Carrier::volume};
    case GiMode::vpl:
    case GiMode::negative:
    case GiMode::val:
      return {Carrier::virtual_lights, Carrier::virtual_lights, Carrier::nobody};
  }
  return {};
}

}  // namespace volgi::screen
