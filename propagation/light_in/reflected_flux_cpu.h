#pragma once
#include <optional>
#include <vector>

#include "core/light.h"
#include "core/visibility/embree_scene.h"
#include "propagation/side_flux.h"
#include "shaders/shared/near_light.shared.h"
#include "shaders/shared/virtual_light.shared.h"
#include "voxel/voxel_grid.h"

namespace volgi {

/// Virtual lights on the host, as a volume's sides take them.
struct VirtualLightsForSides {
  std::vector<shared::VirtualLight> lights;  // reflected ones first
  int reflected = 0;
  /// Parts of each light, SUBLIGHTS_PER_LIGHT of them, whose fine ones send its light; none: the lights do themselves.
  std::vector<shared::SubLight> sublights;
  int sample = 0;  // that they are of (core/sample_sequence.h)
};

/// Rays for so many sides: eight each, but 2^16 at least and 2^19 at most.
size_t automatic_rays(size_t sides);

/// What surfaces reflect of lights [first, end) of the list: rays that leave the lights by their cosine, each with the
/// same power, reflected by what it meets first. The samples' sum is what the lights send, less what leaves the scene,
/// times the albedo met, however small or bent surfaces are beside a cell. A side that is asked for its irradiance at
/// one point instead loses what is nearer than a light's disk is large, and where that point stands under a step: arena
/// kept 0.65 of it, cornell 0.98. Lights along a curve and two powers of the plastic number (Roberts 2018) for the
/// direction are even together. BLEND surfaces stop a ray with probability alpha (hashed). No result depends on the
/// number of threads. Cost: one ray each.
std::vector<FluxSample> reflected_flux(const EmbreeScene& embree, const VirtualLightsForSides& from, size_t first,
                                       size_t end, size_t rays);

/// How far light flies from its first surface, or an emissive one, to the next.
struct Flight {
  float length_m;
  float power;  // sum of the bands [W]
};
/// Of the same rays; those that leave the scene have none.
std::vector<Flight> flights(const EmbreeScene& embree, const VirtualLightsForSides& from, size_t rays);

/// Light in of a volume after a first bounce by virtual lights: A rho E of every side. @param emission_apart  where
/// orders are counted: emission has one more, so what it brings goes in by itself; else all is `punctual`.
/// @param rays  none: automatic_rays(). Twin: screen/bounces/volume/reflected_flux_gl.h, through cells.
SideFlux flux_after_first_bounce(const VolumeSides& sides, const EmbreeScene& embree, const VirtualLightsForSides& from,
                                 bool emission_apart, std::optional<size_t> rays = {});

}  // namespace volgi
