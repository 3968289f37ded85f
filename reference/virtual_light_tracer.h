#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "core/camera.h"
#include "core/scene.h"
#include "core/virtual_light_list.h"
#include "reference/path_integrator.h"
#include "reference/path_tracer.h"

namespace volgi {

struct VirtualLightGatherOptions {
  glm::ivec2 size{512, 512};
  enum class Visibility { exact, none } visibility = Visibility::exact;
  /// Of a light's radius, sqrt(A / pi): what is nearer than that to the receiver, or to the light, hides nothing. Tells
  /// what contact counts for; 0: everything hides.
  double blind_at_receiver = 0.0, blind_at_light = 0.0;
  PathTracerOptions::Light light = PathTracerOptions::Light::full;
  std::uint32_t seed = 1;  // of the chance by which rays pass BLEND surfaces
  int threads = 0;         // 0: all; the picture does not depend on it
};

/// The judge of a renderer's virtual point lights: the same lights, gathered in double precision with a shadow ray from
/// every pixel to every light, so that what is left of a frame's error against this is visibility and interleaving, and
/// what is left of this against path_trace() is sampling and the bounces that the list does not carry.
///
/// One camera ray per pixel centre; there the radiance is, over the lights of each kind,
///   sum of rho/pi · flux · cos_x · cos_l / (pi d² + A)        (docs/conventions.md#virtual-lights)
/// REFLECTED lights make the indirect layer. EMITTED ones stand for the direct light of emissive surfaces, so the
/// direct layer is they, the exact punctual light and the emission that the camera sees. NEGATIVE lights are left out:
/// they stand for visibility. As in path_trace(), light must be on the viewer's side of both normals.
///
/// A light sits on a surface that nobody names, at a position read from a rasterized map. Its shadow rays therefore aim
/// 2 e above it along its normal and end 8 e before that, e = 1e-5 of the longest edge of the scene's bounds
/// (virtual_light_tracer.cpp): a blocker nearer than that to a light is not seen.
///
/// Cost: pixels × lights shadow rays. Deterministic: the same bytes for any number of threads.
class VirtualLightTracer {
 public:
  /// Builds the acceleration structure, once for any number of pictures. @param scene  must outlive this.
  explicit VirtualLightTracer(const Scene& scene);

  /// The punctual lights of the direct layer, in the scene's centred frame: the scene's own until this is called. For
  /// frames in which nothing but lights move.
  void set_lights(const std::vector<Light>& lights) { integrator_.set_lights(lights); }

  /// All layers of a reference picture; its two halves are alike, because nothing is sampled (where the camera looks
  /// through BLEND surfaces or light comes through them, one sample is taken and its noise not known).
  /// @param list  in any centred frame: positions are moved by the difference of the origins, in double.
  ReferencePicture gather(const Camera& camera, const VirtualLightList& list,
                          const VirtualLightGatherOptions& options) const;

 private:
  const Scene& scene_;
  PathIntegrator integrator_;
};

/// VirtualLightTracer(scene).gather(camera, list, options).
ReferencePicture gather_virtual_lights(const Scene& scene, const Camera& camera, const VirtualLightList& list,
                                       const VirtualLightGatherOptions& options);

}  // namespace volgi
