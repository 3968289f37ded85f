#pragma once
#include <memory>

#include "reference/path_tracer.h"

namespace volgi {

/// The picture of path_trace() while it grows: for error against time. One point set a pixel instead of two independent
/// halves, so that after any 2^k samples it is as good as this tracer gets; where every sample starts at the same
/// vertex (Filter::point, no BLEND), the camera's rays are traced once, with the first samples.
/// Memory: about 200 bytes a pixel. Deterministic: the same bytes for any number of threads, and for any steps.
class ProgressivePathTracer {
 public:
  /// Builds the acceleration structure and traces nothing yet.
  /// @param scene    must outlive this.
  /// @param options  samples_per_pixel is not used.
  ProgressivePathTracer(const Scene& scene, const Camera& camera, const PathTracerOptions& options);
  ~ProgressivePathTracer();

  /// Adds this many samples to every pixel. Cost: samples · pixels · path length rays.
  void trace(int samples_per_pixel);
  int samples_per_pixel() const;
  /// The requested light, from all samples so far; black before the first.
  Image image() const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace volgi
