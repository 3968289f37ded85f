#pragma once
#include "core/gl/objects.h"
#include "core/gl/pass_timer.h"
#include "core/gl/program.h"

namespace volgi::screen {

/// Pass "screen/display/accumulate": the mean of pictures that were added since reset(), of all four channels. What is
/// not finite stays so, until reset(). Its rounding grows as the root of their number: 2^-24 sqrt(count / 3) of the
/// mean, 1e-6 after 850. Cost: 48 bytes moved a pixel.
class Accumulate {
 public:
  static constexpr const char* name = "screen/display/accumulate";
  explicit Accumulate(glm::ivec2 size);
  /// The next add() begins anew; mean() stays until then.
  void reset() { count_ = 0; }
  /// @param radiance  RGBA32F of the constructor's size, drawn or stored before a barrier for texture fetches.
  void add(const gl::Texture& radiance, gl::PassTimer& timer);

  int count() const { return count_; }               // pictures in the mean
  const gl::Texture& mean() const { return mean_; }  // RGBA32F; black before the first picture
  size_t bytes() const { return 16 * size_t(mean_.size().x) * size_t(mean_.size().y); }

 private:
  gl::Texture mean_;
  gl::Program program_;
  int count_ = 0;
};

}  // namespace volgi::screen
