#include "core/mipmaps.h"

#include <algorithm>
#include <cmath>

#include "core/image.h"
#include "core/texel_filter_internal.h"

namespace volgi {

namespace {

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

MipLevel coarser(const MipLevel& fine) {
  MipLevel coarse{std::max(1, fine.width / 2), std::max(1, fine.height / 2), {}};
  coarse.texels.reserve(size_t(coarse.width) * size_t(coarse.height));
  const auto at = [&](int x, int y) { return fine.texels[size_t(y) * size_t(fine.width) + size_t(x)]; };
  for (int y = 0; y < coarse.height; ++y) {
    const Taps v = taps(y, coarse.height, fine.height);
    for (int x = 0; x < coarse.width; ++x) {
      const Taps u = taps(x, coarse.width, fine.width);
      coarse.texels.push_back(glm::mix(glm::mix(at(u.first, v.first), at(u.second, v.first), u.share),
                                       glm::mix(at(u.first, v.second), at(u.second, v.second), u.share), v.share));
    }
  }
  return coarse;
}

}  // namespace

std::vector<MipLevel> mip_chain(const TextureImage& image, bool srgb) {
  MipLevel fine{image.width, image.height, {}};
  fine.texels.reserve(image.rgba.size() / 4);
  for (size_t i = 0; i + 3 < image.rgba.size(); i += 4) {
    glm::vec4 t(image.rgba[i], image.rgba[i + 1], image.rgba[i + 2], image.rgba[i + 3]);
    t /= 255.0f;
    if (srgb) t = {srgb_decode(t.x), srgb_decode(t.y), srgb_decode(t.z), t.w};
    fine.texels.push_back(t);
  }
  std::vector<MipLevel> chain{std::move(fine)};
  while (chain.back().width > 1 || chain.back().height > 1) chain.push_back(coarser(chain.back()));
  return chain;
}

Mipmaps::Mipmaps(const Scene& scene) : scene_(scene) {
  for (auto& chains : chains_) chains.resize(scene.images.size());
}

void Mipmaps::prepare(int texture, bool srgb) {
  const auto image = size_t(scene_.textures[size_t(texture)].image);
  Chain& chain = chains_[srgb ? 1 : 0][image];
  if (chain.empty()) chain = mip_chain(scene_.images[image], srgb);
}

glm::vec4 Mipmaps::sample(int texture, glm::vec2 uv, float lod, bool srgb) const {
  const Texture& t = scene_.textures[size_t(texture)];
  const Chain& levels = chains_[srgb ? 1 : 0][size_t(t.image)];
  const glm::vec2 at = wrapped(uv, t.sampler);
  const auto level = [&](int k, bool nearest) {
    const MipLevel& l = levels[size_t(k)];
    const glm::vec4* const texels = l.texels.data();
    return filter_texels(t.sampler, {l.width, l.height}, at, nearest,
                         [&](int x, int y) { return texels[size_t(y) * size_t(l.width) + size_t(x)]; });
  };
  if (!(lod > 0.0f)) return level(0, t.sampler.magnify_nearest);
  const bool nearest = t.sampler.minify_nearest;
  if (!t.sampler.mipmap) return level(0, nearest);
  const int coarsest = int(levels.size()) - 1;
  if (t.sampler.mipmap_nearest) return level(std::clamp(int(std::ceil(lod + 0.5f)) - 1, 0, coarsest), nearest);
  const float clamped = std::min(lod, float(coarsest));
  const int first = std::max(std::min(int(clamped), coarsest - 1), 0);
  return glm::mix(level(first, nearest), level(std::min(first + 1, coarsest), nearest), clamped - float(first));
}

size_t Mipmaps::bytes() const {
  size_t sum = 0;
  for (const auto& chains : chains_) {
    for (const Chain& chain : chains) {
      for (const MipLevel& level : chain) sum += level.texels.size() * sizeof(glm::vec4);
    }
  }
  return sum;
}

}  // namespace volgi
