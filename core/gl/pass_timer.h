#pragma once
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace volgi::gl {

/// Times passes by name. On hardware: timer queries (GL_TIMESTAMP pairs), read frames later without waiting. On a
/// software rasterizer, where queries are wrong by factors of 75: wall clock between two glFinish, but only when
/// `timing` is on, so that an untimed frame is not serialised. Also pushes the name as a GL debug group.
class PassTimer {
 public:
  enum class Kind { gpu, wall };
  PassTimer(bool software, bool timing);
  ~PassTimer();

  class Scope {
   public:
    ~Scope();
    Scope(Scope&&) noexcept;
    Scope(const Scope&) = delete;

   private:
    friend class PassTimer;
    Scope(PassTimer* timer, size_t index);
    PassTimer* timer_;
    size_t index_;
  };
  /// One name: "propagation/propagate". A name used again in the same frame adds to its time. Scopes do not nest.
  [[nodiscard]] Scope scope(std::string_view pass_name);

  void begin_frame();
  /// @throws Error(no_device) when OpenGL has reported an error (core/gl/context.h).
  void end_frame();

  struct PassTime {
    std::string name;
    double gpu_ms;  // GPU time (gpu) or wall time (wall)
    double cpu_ms;  // time spent issuing the commands
  };
  /// Median of every pass over the frames so far, in order of first use. Waits for outstanding queries.
  std::vector<PassTime> medians();
  /// The newest frame whose times are all known, in order of first use: of a GPU a few frames back. Does not wait.
  std::vector<PassTime> latest() const;
  struct FrameTime {
    double min_ms, median_ms, max_ms;
  };
  /// Wall time from begin_frame to end_frame (with a glFinish at both ends when timing).
  FrameTime frame_time() const;
  /// For finding barriers that are missing: from now on every pass waits until all of it is done and seen (glFinish,
  /// glMemoryBarrier of everything), as from the start where VOLGI_SERIALISE is in the environment. The picture is the
  /// same, byte for byte, or passes race.
  void serialise_passes() { serialised_ = true; }
  void reset();  // forgets all frames (after warm-up)
  Kind kind() const;

 private:
  struct Data;
  static void wait_for_all();
  std::unique_ptr<Data> data_;
  bool serialised_ = false;
};

}  // namespace volgi::gl
