#pragma once
#include <glm/glm.hpp>
#include <vector>

#include "core/sky.h"
#include "propagation/ordinates.h"

namespace volgi {

/// What of a sky each direction of a quadrature carries into a grid: the mean of its radiance over what lies nearest to
/// the direction, times the direction's weight [W m^-2]. A constant sky streams in exactly as cells would carry it.
/// @return  by octant (bit a: light goes up axis a), then by the set's directions.
std::vector<glm::vec3> rim_inflow(const Sky& sky, const OrdinateSet& set);

/// Power [W] of a direction's inflow through one face of the rim, by the face's axis: (pi / t) d_axis h^2 of it.
/// Isotropic radiance L sends pi L h^2 through the face, all directions together.
inline glm::vec3 inflow_per_flux(const OrdinateSet& set, size_t i, float cell_size_m) {
  return set.directions[i] * (3.14159265f / set.t * cell_size_m * cell_size_m);
}

}  // namespace volgi
