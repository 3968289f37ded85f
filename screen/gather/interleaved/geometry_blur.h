#pragma once
#include "core/gl/objects.h"
#include "core/gl/program.h"

namespace volgi::screen {

struct GeometryBlurOptions {
  /// The blur joins pixels no farther apart than this part of the scene's diagonal (alpha of the paper), ...
  float distance = 0.1f;
  float cosine = 0.8f;     // ... whose normals have at least this cosine (beta), ...
  float off_plane = 0.2f;  // ... and which lie on one another's tangent plane, to this sine of the way's angle
};

/// Joins what the pixels of interleaved blocks have gathered
/// (shaders/screen/gather/interleaved/geometry_blur.comp.glsl), along one axis and then the other; from irradiance to
/// reflected radiance. Estimates as well by how much a pixel may err. Cost a pixel: 6 n - 3 texels for blocks of n x n.
/// Part of its callers' passes.
class GeometryBlur {
 public:
  GeometryBlur(glm::ivec2 size, int interleave, const GeometryBlurOptions& options);
  enum class Estimate { anew, adds };  // adds: to that of another picture
  /// The G-buffer must be bound. @param from, to  RGBA32F of its size.
  void run(const gl::Texture& from, const gl::Texture& to, Estimate estimate, float scene_diagonal_m);
  const gl::Texture& error_estimate() const { return error_estimate_; }  // R32F: radiance
  size_t bytes() const { return 20 * size_t(size_.x) * size_t(size_.y); }

 private:
  glm::ivec2 size_;
  int interleave_;
  GeometryBlurOptions options_;
  gl::Texture half_blurred_, error_estimate_;
  gl::Program program_;
};

/// Where a subset's pixel lies in its block of n x n: subsets that follow on one another lie far apart, as the numbers
/// of a matrix for ordered dithering do.
glm::ivec2 place_in_block(int subset, int n);

}  // namespace volgi::screen
