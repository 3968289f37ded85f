#pragma once
#include <functional>
#include <memory>
#include <vector>

#include "core/light.h"
#include "core/visibility/embree_scene.h"

namespace volgi {

/// A ray of a light, and what it carries.
struct LightRay {
  glm::vec3 origin, direction;
  glm::vec3 power;     // that leaves [W]
  std::uint32_t seed;  // its own: what it meets by chance is hashed with
  shared::PunctualLight light;
  bool from_afar;  // a sun's

  /// What is left of it after some way [m].
  glm::vec3 power_after(float distance) const;
};

/// The rays of the scene's punctual lights through the texels of their reflective shadow maps' layers, by row of
/// texels: those of light_flux(), for whoever else meets surfaces. They do not depend on what they meet.
class LightRays {
 public:
  /// @param texels_on_edge  as light_flux().
  LightRays(const Scene& scene, int texels_on_edge);
  ~LightRays();

  size_t rows() const { return rows_.size(); }
  void for_each_of_row(size_t row, const std::function<void(const LightRay&)>& take) const;

 private:
  struct Layer;
  struct Row {
    size_t layer;
    int row;
  };
  std::vector<Layer> layers_;
  std::vector<Row> rows_;
};

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
