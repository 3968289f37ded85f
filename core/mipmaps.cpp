#include "core/mipmaps.h"

#include <algorithm>
#include <cmath>

#include "core/image.h"
#include "core/surface.h"

namespace volgi {

namespace {

/// Coordinate in [0,1] of one period. NaN becomes 0.
float wrapped(float u, Wrap wrap) {
  if (!std::isfinite(u)) return 0.0f;
  if (wrap == Wrap::clamp_to_edge) return std::clamp(u, 0.0f, 1.0f);
  if (wrap == Wrap::repeat) return u - std::floor(u);
  const float t = u - 2.0f * std::floor(0.5f * u);
  return t > 1.0f ? 2.0f - t : t;
}

int wrapped_texel(int i, int size, Wrap wrap) {
  if (wrap == Wrap::repeat) return (i + size) % size;
  return std::clamp(i, 0, size - 1);
}

/// The two texels and the share of the second that a box filter's blit takes for texel `i` of the coarser level.
struct Taps {
  int first, second;
  float share;
};
Taps taps(int i, int coarse, int fine) {
  const float at = (float(i) + 0.5f) * float(fine) / float(coarse) - 0.5f;
  const int first = int(std::floor(at));
  return {std::clamp(first, 0, fine - 1), std::clamp(first + 1, 0, fine - 1), at - float(first)};
}

}  // namespace

Mipmaps::Mipmaps(const Scene& scene) : scene_(scene) {
  for (auto& chains : chains_) chains.resize(scene.images.size());
}

void Mipmaps::prepare(int texture, bool srgb) {
  const int image = scene_.textures[size_t(texture)].image;
  Chain& chain = chains_[srgb ? 1 : 0][size_t(image)];
  if (!chain.empty()) return;
  const TextureImage& source = scene_.images[size_t(image)];
  Level fine{source.width, source.height, {}};
  fine.texels.reserve(source.rgba.size() / 4);
  for (size_t i = 0; i + 3 < source.rgba.size(); i += 4) {
    glm::vec4 t(source.rgba[i], source.rgba[i + 1], source.rgba[i + 2], source.rgba[i + 3]);
    t /= 255.0f;
    if (srgb) t = {srgb_decode(t.x), srgb_decode(t.y), srgb_decode(t.z), t.w};
    fine.texels.push_back(t);
  }
  while (fine.width > 1 || fine.height > 1) {
    Level coarse{std::max(1, fine.width / 2), std::max(1, fine.height / 2), {}};
    coarse.texels.resize(size_t(coarse.width) * size_t(coarse.height));
    const auto at = [&](int x, int y) { return fine.texels[size_t(y) * size_t(fine.width) + size_t(x)]; };
    for (int y = 0; y < coarse.height; ++y) {
      const Taps v = taps(y, coarse.height, fine.height);
      for (int x = 0; x < coarse.width; ++x) {
        const Taps u = taps(x, coarse.width, fine.width);
        coarse.texels[size_t(y) * size_t(coarse.width) + size_t(x)] =
            glm::mix(glm::mix(at(u.first, v.first), at(u.second, v.first), u.share),
                     glm::mix(at(u.first, v.second), at(u.second, v.second), u.share), v.share);
      }
    }
    chain.push_back(coarse);
    fine = std::move(coarse);
  }
}

glm::vec4 Mipmaps::sample_level(const Texture& t, const Level& level, glm::vec2 uv) const {
  const float x = wrapped(uv.x, t.sampler.wrap_s) * float(level.width);
  const float y = wrapped(uv.y, t.sampler.wrap_t) * float(level.height);
  const auto at = [&](int i, int j) { return level.texels[size_t(j) * size_t(level.width) + size_t(i)]; };
  if (t.sampler.minify_nearest) return at(std::min(int(x), level.width - 1), std::min(int(y), level.height - 1));
  const glm::vec2 corner(std::floor(x - 0.5f), std::floor(y - 0.5f));
  const glm::vec2 share(x - 0.5f - corner.x, y - 0.5f - corner.y);
  const int x0 = wrapped_texel(int(corner.x), level.width, t.sampler.wrap_s);
  const int x1 = wrapped_texel(int(corner.x) + 1, level.width, t.sampler.wrap_s);
  const int y0 = wrapped_texel(int(corner.y), level.height, t.sampler.wrap_t);
  const int y1 = wrapped_texel(int(corner.y) + 1, level.height, t.sampler.wrap_t);
  return glm::mix(glm::mix(at(x0, y0), at(x1, y0), share.x), glm::mix(at(x0, y1), at(x1, y1), share.x), share.y);
}

glm::vec4 Mipmaps::sample(int texture, glm::vec2 uv, float lod, bool srgb) const {
  const Texture& t = scene_.textures[size_t(texture)];
  const Chain& levels = chains_[srgb ? 1 : 0][size_t(t.image)];
  if (!(lod > 0.0f) || !t.sampler.mipmap || levels.empty()) return sample_texture(scene_, texture, uv, srgb);
  const auto level = [&](int k) {
    return k == 0 ? sample_texture(scene_, texture, uv, srgb) : sample_level(t, levels[size_t(k - 1)], uv);
  };
  const int coarsest = int(levels.size());
  if (t.sampler.mipmap_nearest) return level(std::clamp(int(std::ceil(lod + 0.5f)) - 1, 0, coarsest));
  const float clamped = std::min(lod, float(coarsest));
  const int first = std::min(int(clamped), coarsest - 1);
  return glm::mix(level(first), level(first + 1), clamped - float(first));
}

}  // namespace volgi
