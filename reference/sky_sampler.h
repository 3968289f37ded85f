#pragma once
#include <glm/glm.hpp>
#include <vector>

#include "core/sky.h"

namespace volgi {

struct SkySample {
  glm::vec3 towards;  // unit
  glm::vec3 radiance;
  float pdf = 0.0f;  // per solid angle [1/sr]; 0: nothing was sampled
};

/// Directions chosen in proportion to a sky's luminance, texel by texel; a texel weighs what its bilinear neighbours
/// leave in it, so that no light has density 0. A constant sky needs none of it: the hemisphere's own sampling is best.
class SkySampler {
 public:
  /// @param sky  must outlive this.
  explicit SkySampler(const Sky& sky);
  SkySample sample(glm::vec2 xi) const;
  float pdf(glm::vec3 towards) const;

 private:
  size_t index(int x, int y) const { return size_t(y) * size_t(width_) + size_t(x); }
  float texel_pdf(size_t texel) const;  // per solid angle

  const Sky& sky_;
  int width_, height_;
  std::vector<double> rows_;     // cumulative probability of rows
  std::vector<double> columns_;  // of texels within each row
  std::vector<float> texels_;    // probability
};

}  // namespace volgi
