#pragma once
#include <filesystem>

#include "core/camera.h"
#include "core/scene.h"
#include "reference/metrics.h"
#include "reference/path_tracer.h"
#include "reference/picture_files.h"

namespace volgi::app {

/// What pictures of a scene's indirect light are measured against: region noedge, the reference's own noise taken out.
class Yardstick {
 public:
  /// @param reference  with layers. @throws Error(bad_input) naming `name` when it has none, or no such light.
  Yardstick(ReferenceFile reference, const std::string& name);

  const ReferenceFile& reference() const { return reference_; }
  /// Noise of the reference itself, RMS in percent of its mean.
  double noise_percent() const;
  Metrics::Relative measure(const Image& image) const;
  /// Root mean square error in percent of the reference's mean, noise removed where it is known.
  double error_percent(const Image& image) const;

 private:
  ReferenceFile reference_;
  Mask mask_;
};

/// Indirect light of the scene by path_trace(), from `folder` when it was traced before: the file is named after a hash
/// of all that the light of the scene depends on, the size, samples, seed and bounces. Nothing in the name knows the
/// path tracer's own code: a new one needs an empty folder. Made if need be.
ReferenceFile cached_reference(const Scene& scene, const Camera& camera, PathTracerOptions options,
                               const std::filesystem::path& folder);

}  // namespace volgi::app
