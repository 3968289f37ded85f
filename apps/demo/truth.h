#pragma once
#include <chrono>
#include <memory>
#include <optional>
#include <utility>

#include "apps/demo/background_reference.h"
#include "apps/demo/session.h"
#include "core/gl/objects.h"

namespace volgi::demo {

/// How the reference is looked at: not at all, right of a line, instead of the picture, or as what it differs by.
enum class TruthMode { off, beside, alone, error };

/// The path-traced picture of what a session shows, which refines while nothing moves.
class Truth {
 public:
  TruthMode mode() const { return mode_; }
  void set_mode(TruthMode mode) { mode_ = mode; }
  /// Share of the picture's width that is left of the line.
  float wipe() const { return wipe_; }
  void set_wipe(float share) { wipe_ = share; }

  /// Starts where the picture has stood still for a moment, stops where something has moved, and brings what is there
  /// to the GPU.
  void step(const Session& session);

  bool has_picture() const { return snapshot_ != nullptr && snapshot_->samples > 0; }
  int samples() const { return has_picture() ? snapshot_->samples : 0; }
  double seconds() const { return has_picture() ? snapshot_->seconds : 0.0; }
  std::string failure() const { return reference_.failure(); }
  /// Whether radiance() is another one than at the last call.
  bool is_new() { return std::exchange(new_, false); }
  /// RGBA32F of the picture's size; only where has_picture().
  const gl::Texture& radiance() const { return radiance_; }
  /// Of the session's picture against it; at most twice a second anew. Waits for the GPU.
  const std::optional<Metrics>& measured(const Session& session);

 private:
  using Clock = std::chrono::steady_clock;
  void begin(const Session& session);
  void stop();
  void take(std::shared_ptr<const ReferenceSnapshot> snapshot);

  TruthMode mode_ = TruthMode::off;
  float wipe_ = 0.5f;
  BackgroundReference reference_;
  bool running_ = false;
  std::uint64_t picture_version_ = 0, scene_version_ = 0;
  std::shared_ptr<const Scene> scene_;  // as it was traced
  Clock::time_point changed_, measured_at_;
  std::shared_ptr<const ReferenceSnapshot> snapshot_;
  gl::Texture radiance_;
  bool new_ = false;
  std::optional<Metrics> measured_;
  std::pair<int, int> measured_of_{0, 0};  // samples of both
};

}  // namespace volgi::demo
