#pragma once
// How a texture's texels become a value at a coordinate; for surface.cpp and mipmaps.cpp.
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>

#include "core/image.h"
#include "core/scene.h"

namespace volgi {

/// Largest whole number that is not larger; without SSE4.1 much quicker than std::floor. |x| < 2^30.
inline int floor_to_int(float x) {
  const int toward_zero = int(x);
  return toward_zero - int(float(toward_zero) > x);
}

/// Linear RGBA of four bytes; `srgb` decodes RGB.
inline glm::vec4 decoded_texel(const std::uint8_t* p, bool srgb) {
  static const std::array<float, 256> decode = [] {
    std::array<float, 256> t{};
    for (size_t i = 0; i < t.size(); ++i) t[i] = srgb_decode(float(i) / 255.0f);
    return t;
  }();
  if (!srgb) return glm::vec4(p[0], p[1], p[2], p[3]) / 255.0f;
  return {decode[p[0]], decode[p[1]], decode[p[2]], float(p[3]) / 255.0f};
}

/// Coordinate in [0,1] of one period, so that huge ones cannot overflow an int. NaN becomes 0.
inline float wrapped(float u, Wrap wrap) {
  if (!std::isfinite(u)) return 0.0f;
  if (wrap == Wrap::clamp_to_edge) return std::clamp(u, 0.0f, 1.0f);
  if (!(std::abs(u) < 1e6f)) u = std::fmod(u, 2.0f);  // exact, and a period of both
  if (wrap == Wrap::repeat) return u - float(floor_to_int(u));
  const float t = u - 2.0f * float(floor_to_int(0.5f * u));
  return t > 1.0f ? 2.0f - t : t;
}
inline glm::vec2 wrapped(glm::vec2 uv, const Sampler& sampler) {
  return {wrapped(uv.x, sampler.wrap_s), wrapped(uv.y, sampler.wrap_t)};
}

/// Texel -1 ... size: the neighbours outside the image too. A mirrored one is the edge itself.
inline int wrapped_texel(int i, int size, Wrap wrap) {
  if (wrap != Wrap::repeat) return std::clamp(i, 0, size - 1);
  return i < 0 ? i + size : i < size ? i : i - size;
}

/// Bilinear or nearest value of an image of `size` texels; texel(x, y) gives one. @param uv  wrapped
template <typename Texel>
glm::vec4 filter_texels(const Sampler& sampler, glm::ivec2 size, glm::vec2 uv, bool nearest, const Texel& texel) {
  const float x = uv.x * float(size.x), y = uv.y * float(size.y);
  if (nearest) return texel(std::min(int(x), size.x - 1), std::min(int(y), size.y - 1));
  const int left = floor_to_int(x - 0.5f), low = floor_to_int(y - 0.5f);
  const glm::vec2 share(x - 0.5f - float(left), y - 0.5f - float(low));
  const int x0 = wrapped_texel(left, size.x, sampler.wrap_s), x1 = wrapped_texel(left + 1, size.x, sampler.wrap_s);
  const int y0 = wrapped_texel(low, size.y, sampler.wrap_t), y1 = wrapped_texel(low + 1, size.y, sampler.wrap_t);
  return glm::mix(glm::mix(texel(x0, y0), texel(x1, y0), share.x), glm::mix(texel(x0, y1), texel(x1, y1), share.x),
                  share.y);
}

}  // namespace volgi
