#pragma once
#include <vector>

#include "core/light.h"
#include "core/visibility/embree_scene.h"

namespace volgi {

/// What surfaces lit by the scene's punctual lights reflect, found without GL: rays from every light through the texels
/// of its reflective shadow map's layers (core/light_layers.h). Each ray carries the power I dω (a sun's: E dA) that is
/// known beforehand, so that the samples' sum is the light's reflected power whatever the surfaces look like. A twin of
/// screen/bounces/volume/inject_reflective_shadow_map; one ray a texel, somewhere in it. BLEND surfaces stop a
/// ray with probability alpha (hashed). Cost: one ray a texel, in parallel; the result does not depend on threads.
/// @param texels_on_edge   of a spot's layer; a point light's faces have half, a sun's layer twice as many. At
/// least 16.
std::vector<FluxSample> light_flux(const EmbreeScene& embree, int texels_on_edge);

/// One rank's share of the rays; their numbers are in the order of those of all ranks together.
std::vector<NumberedFluxSample> light_flux(const EmbreeScene& embree, int texels_on_edge, int rank, int ranks);

}  // namespace volgi
