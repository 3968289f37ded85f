#pragma once
#include "reference/path_integrator.h"
#include "reference/path_tracer.h"

// Private to the room: samples of one pixel, for everything that traces paths into pictures.
namespace volgi {

/// Samples of a pixel, summed in double and always in the same order.
struct LightSum {
  glm::dvec3 direct{0.0};
  glm::dvec3 indirect{0.0};
};

glm::dvec3 asked_for(const LightSum& sum, PathTracerOptions::Light light);

/// Thread-safe. Scene, camera and options must outlive it.
class PixelTracer {
 public:
  PixelTracer(const Scene& scene, const Camera& camera, const PathTracerOptions& options);
  /// Camera and options have changed in place. Not while pixels are traced.
  void options_changed();

  /// What the camera sees at the pixel's centre; false where it sees nothing.
  bool centre(glm::ivec2 pixel, CameraRay& ray, PathVertex& vertex) const;
  /// PathIntegrator::lights_reaching(), by the same chance for all pixels.
  std::uint32_t lights_reaching(const PathVertex& vertex) const;
  /// Whether every sample of a pixel starts from what is at its centre.
  bool starts_at_centre() const { return starts_at_centre_; }
  /// Samples `first` ... `first + count - 1` of one of the pixel's independent point sets.
  /// @param known  what is at the centre where samples start there, else null.
  void add_samples(glm::ivec2 pixel, const PathVertex* known, std::uint32_t point_set, int first, int count,
                   LightSum& sum) const;

  /// Samples of a ray that meets nothing: the sky.
  void add_background(const CameraRay& ray, int count, LightSum& sum) const;

 private:
  void add_sample(glm::vec2 corner, const PathVertex* known, PathSampler sampler, LightSum& sum) const;

  const Camera& camera_;
  const PathTracerOptions& options_;
  PathIntegrator integrator_;
  int max_bounces_ = 0;
  bool starts_at_centre_ = false;
};

}  // namespace volgi
