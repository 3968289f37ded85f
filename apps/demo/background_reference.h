#pragma once
#include <memory>
#include <optional>
#include <string>

#include "core/camera.h"
#include "core/image.h"
#include "core/scene.h"
#include "reference/metrics.h"
#include "reference/path_tracer.h"

namespace volgi::demo {

/// A reference while it is being refined.
struct ReferenceSnapshot {
  Image image;
  Image noise;           // ProgressivePathTracer::noise(); empty before there are two samples
  int samples = 0;       // of every pixel
  double seconds = 0.0;  // since start(), the acceleration structure included where it had to be built
};

/// Path traces a picture on threads in the background that take only what time nobody else wants.
///
/// The threads are this class's own, at Linux' SCHED_IDLE (where that is refused, at nice 19), and share the picture's
/// tiles out among themselves. None of it runs through TBB: its workers, and their priorities, belong to the whole
/// program, and a worker that is started while a slow thread waits inherits that thread's priority for good. The one
/// call that does, Embree's, builds in an arena of one thread, which wakes no worker.
///
/// Calls other than the constructor and the destructor take no longer than it takes to lock a mutex: nobody waits for
/// rays. All of them are for one thread at a time.
class BackgroundReference {
 public:
  /// @param threads  0: all of the machine's but two, at least one. Started with the first start().
  explicit BackgroundReference(int threads = 0);
  /// Waits for the threads to leave: for a pixel each, and for an acceleration structure that is being built.
  ~BackgroundReference();
  BackgroundReference(const BackgroundReference&) = delete;
  BackgroundReference& operator=(const BackgroundReference&) = delete;

  /// Begins a picture of 250 bytes a pixel; one that is under way is dropped. With the scene of the one before (the
  /// same object) its acceleration structure is used again.
  /// @param scene    must not change any more.
  /// @param options  its samples_per_pixel is where refining ends; its threads are not used.
  void start(std::shared_ptr<const Scene> scene, const Camera& camera, const PathTracerOptions& options);
  /// Nothing is traced any more; latest() stays. Threads let go within the pixel that each is at; an acceleration
  /// structure is built to its end, for the next start().
  void stop();

  /// The picture after the last sample that all pixels have; null before the first one since start().
  std::shared_ptr<const ReferenceSnapshot> latest() const;
  /// Whether there is still something to do, or a thread has not let go yet.
  bool busy() const;
  /// Why there is no picture; empty: nothing went wrong.
  std::string failure() const;
  int threads() const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

/// How far a picture is from a reference of the same size, over all pixels (measure()): `ratio` is its energy,
/// `rmse_pct_denoised` the error without the reference's noise, which is absent before there are two samples.
/// Cost: about 0.25 s a megapixel: once a snapshot, on a thread that no frame waits for.
Metrics figures(const Image& picture, const ReferenceSnapshot& reference);

/// error_colors() over all pixels: red where the picture is too bright, blue where too dark.
Image signed_error_map(const Image& picture, const Image& reference);

}  // namespace volgi::demo
