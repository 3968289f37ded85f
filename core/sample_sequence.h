#pragma once
#include <cstdint>
#include <glm/glm.hpp>

#include "core/halton.h"

namespace volgi {

/// Pictures k = 0, 1, 2 ... that are averaged into one, for as long as anybody likes: each of them makes its choices
/// elsewhere than the others, and any first n of them together make theirs evenly. Picture 0 is the one that is made
/// when there are no others.
///
/// What is chosen goes by a sequence of its own, a base of radical inverses, so that no two choices go together.
enum class SampleChoice : unsigned {
  coverage = 2,         // which pixels BLEND covers; even steps after every power of two
  chosen_lights = 3,    // which of their candidates become virtual lights
  candidates = 5,       // where in their strata candidates lie
  negative_lights = 7,  // the places of negative lights
  seen_from = 7,        // the light from whose place its cluster is seen
  sky_azimuth = 3,      // which way the sky's parts are turned; they choose no virtual lights
};

/// By how much of a step choices of picture k are moved, in [0, 1); 0 for k = 0.
inline double sample_shift(SampleChoice choice, std::uint64_t k) { return radical_inverse(unsigned(choice), k); }

/// Where in each of its strata picture k has its candidate, in [0, 1): in the middle for k = 0.
inline double place_in_strata(std::uint64_t k) { return glm::fract(0.5 + sample_shift(SampleChoice::candidates, k)); }

/// The first of the `count` points of the Halton sequence (core/halton.h) that picture k takes: those of n pictures are
/// the sequence's first n * count.
inline std::uint64_t first_halton_point(std::uint64_t k, int count) { return 1 + k * std::uint64_t(count); }

/// Where in their pixels samples of picture k lie, from the centre, in [-1/2, 1/2)². An additive recurrence (Roberts
/// 2018: powers of 1/1.3247..., the root of x³ = x + 1) that begins at the centre; bases 2 and 3 are taken.
inline glm::dvec2 pixel_shift(std::uint64_t k) {
  constexpr glm::dvec2 step(0.7548776662466927, 0.5698402909980532);
  return glm::fract(0.5 + double(k) * step) - 0.5;
}

/// By how much of a cell the grid of picture k is moved on each axis, in [-1/2, 1/2)³. An additive recurrence (Roberts
/// 2018: powers of 1/1.2207..., the root of x⁴ = x + 1) that begins at 0; it goes with no other choice.
inline glm::dvec3 grid_shift(std::uint64_t k) {
  constexpr glm::dvec3 step(0.8191725133961645, 0.6710436067037893, 0.5497004779019703);
  return glm::fract(0.5 + double(k) * step) - 0.5;
}

}  // namespace volgi
