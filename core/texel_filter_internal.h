#pragma once
// How a texture's texels become a value at a coordinate; for surface.cpp and mipmaps.cpp.
#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

#include "core/scene.h"

namespace volgi {

/// Coordinate in [0,1] of one period, so that huge ones cannot overflow an int. NaN becomes 0.
inline float wrapped(float u, Wrap wrap) {
  if (!std::isfinite(u)) return 0.0f;
  if (wrap == Wrap::clamp_to_edge) return std::clamp(u, 0.0f, 1.0f);
  if (wrap == Wrap::repeat) return u - std::floor(u);
  const float t = u - 2.0f * std::floor(0.5f * u);
  return t > 1.0f ? 2.0f - t : t;
}

/// Neighbour outside the image: a mirrored one is the edge itself.
inline int wrapped_texel(int i, int size, Wrap wrap) {
  if (wrap == Wrap::repeat) return (i + size) % size;
  return std::clamp(i, 0, size - 1);
}

/// Bilinear or nearest value of an image of `size` texels; texel(x, y) gives one.
template <typename Texel>
glm::vec4 filter_texels(const Sampler& sampler, glm::ivec2 size, glm::vec2 uv, bool nearest, const Texel& texel) {
  const float x = wrapped(uv.x, sampler.wrap_s) * float(size.x);
  const float y = wrapped(uv.y, sampler.wrap_t) * float(size.y);
  if (nearest) return texel(std::min(int(x), size.x - 1), std::min(int(y), size.y - 1));
  const glm::vec2 corner(std::floor(x - 0.5f), std::floor(y - 0.5f));
  const glm::vec2 share(x - 0.5f - corner.x, y - 0.5f - corner.y);
  const int x0 = wrapped_texel(int(corner.x), size.x, sampler.wrap_s);
  const int x1 = wrapped_texel(int(corner.x) + 1, size.x, sampler.wrap_s);
  const int y0 = wrapped_texel(int(corner.y), size.y, sampler.wrap_t);
  const int y1 = wrapped_texel(int(corner.y) + 1, size.y, sampler.wrap_t);
  return glm::mix(glm::mix(texel(x0, y0), texel(x1, y0), share.x), glm::mix(texel(x0, y1), texel(x1, y1), share.x),
                  share.y);
}

}  // namespace volgi
