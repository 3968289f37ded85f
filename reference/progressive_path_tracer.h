#pragma once
#include <atomic>
#include <memory>

#include "reference/path_tracer.h"

namespace volgi {

/// The picture of path_trace() while it grows: for error against time, and for looking at. Where every sample starts at
/// the same vertex (Filter::point, no BLEND), the camera's rays are traced once, with the first samples.
/// Memory: about 250 bytes a pixel. Deterministic: the same bytes for any number of threads, and for any steps.
class ProgressivePathTracer {
 public:
  /// Where the samples of a pixel come from. one: a single set, so that after any 2^k samples the picture is as good as
  /// this tracer gets. two: in turn from the two independent sets of path_trace()'s halves, so that noise() is known.
  enum class PointSets { one, two };

  /// Builds the acceleration structure and traces nothing yet.
  /// @param scene    must outlive this.
  /// @param options  samples_per_pixel is not used.
  ProgressivePathTracer(const Scene& scene, const Camera& camera, const PathTracerOptions& options,
                        PointSets sets = PointSets::one);
  ~ProgressivePathTracer();

  /// Begins another picture of the same scene, with the acceleration structure that there is: what a new tracer would
  /// do.
  void restart(const Camera& camera, const PathTracerOptions& options);

  /// Adds this many samples to every pixel. Cost: samples · pixels · path length rays.
  void trace(int samples_per_pixel);
  int samples_per_pixel() const;
  /// The requested light, from all samples so far; black before the first.
  Image image() const;
  /// As large as the noise of image() is: the difference of the two sets' means, scaled to that. Empty with
  /// one set, and before there are two samples.
  Image noise() const;

  // The next sample of all pixels in parts, for a caller with threads of its own: each part once, in any order and at
  // the same time, then finish_sample().
  int part_count() const;
  /// @returns false, before the end, once `cancelled` is true: only restart() then makes this useful again. It is
  /// looked at before every pixel.
  bool trace_part(int part, const std::atomic<bool>& cancelled);
  void finish_sample();

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace volgi
