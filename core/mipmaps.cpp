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

/// Makes rows of coarser levels of those before them, as soon as both that they need are there.
class RowPyramid {
 public:
  using Visit = std::function<void(int, int, std::span<const glm::vec4>)>;
  RowPyramid(int width, int height, const Visit& visit) : visit_(visit) {
    levels_.push_back({width, height, {}, {}, 0});
    while (levels_.back().width > 1 || levels_.back().height > 1)
      levels_.push_back({std::max(1, levels_.back().width / 2), std::max(1, levels_.back().height / 2), {}, {}, 0});
  }

  void push(size_t k, int y, std::vector<glm::vec4>& row) {
    visit_(int(k), y, row);
    if (k + 1 == levels_.size()) return;
    Level& fine = levels_[k];
    Level& coarse = levels_[k + 1];
    std::swap(fine.before, fine.last);
    std::swap(fine.last, row);
    while (coarse.done < coarse.height) {
      const Taps v = taps(coarse.done, coarse.height, fine.height);
      if (v.second > y) break;
      std::vector<glm::vec4> made = mixed(v.first == y ? fine.last : fine.before, fine.last, v.share, fine, coarse);
      push(k + 1, coarse.done++, made);
    }
  }

 private:
  struct Level {
    int width, height;
    std::vector<glm::vec4> before, last;  // rows
    int done;                             // rows made
  };

  static std::vector<glm::vec4> mixed(const std::vector<glm::vec4>& a, const std::vector<glm::vec4>& b, float share,
                                      const Level& fine, const Level& coarse) {
    std::vector<glm::vec4> row;
    row.reserve(size_t(coarse.width));
    for (int x = 0; x < coarse.width; ++x) {
      const Taps u = taps(x, coarse.width, fine.width);
      row.push_back(glm::mix(glm::mix(a[size_t(u.first)], a[size_t(u.second)], u.share),
                             glm::mix(b[size_t(u.first)], b[size_t(u.second)], u.share), share));
    }
    return row;
  }

  const Visit& visit_;
  std::vector<Level> levels_;
};

MipLevel empty_level(const TextureImage& image, int level) {
  MipLevel l{std::max(image.width >> level, 1), std::max(image.height >> level, 1), {}};
  l.texels.reserve(size_t(l.width) * size_t(l.height));
  return l;
}

}  // namespace

int mip_count(const TextureImage& image) {
  int count = 1;
  for (int edge = std::max(image.width, image.height); edge > 1; edge /= 2) ++count;
  return count;
}

void visit_mip_rows(const TextureImage& image, bool srgb, const RowPyramid::Visit& visit) {
  RowPyramid pyramid(image.width, image.height, visit);
  std::vector<glm::vec4> row;
  for (int y = 0; y < image.height; ++y) {
    row.clear();
    const std::uint8_t* const texels = image.rgba.data() + 4 * size_t(y) * size_t(image.width);
    for (int x = 0; x < image.width; ++x) row.push_back(decoded_texel(texels + 4 * size_t(x), srgb));
    pyramid.push(0, y, row);
  }
}

std::vector<MipLevel> mip_chain(const TextureImage& image, bool srgb) {
  std::vector<MipLevel> chain;
  chain.reserve(size_t(mip_count(image)));
  for (int level = 0; level < mip_count(image); ++level) chain.push_back(empty_level(image, level));
  visit_mip_rows(image, srgb, [&](int level, int, std::span<const glm::vec4> row) {
    auto& texels = chain[size_t(level)].texels;
    texels.insert(texels.end(), row.begin(), row.end());
  });
  return chain;
}

Mipmaps::Mipmaps(const Scene& scene) : scene_(scene) {
  for (auto& chains : chains_) chains.resize(scene.images.size());
}

void Mipmaps::prepare(int texture, bool srgb) {
  const auto image = size_t(scene_.textures[size_t(texture)].image);
  Chain& chain = chains_[srgb ? 1 : 0][image];
  if (!chain.empty()) return;
  for (int level = 1; level < mip_count(scene_.images[image]); ++level)
    chain.push_back(empty_level(scene_.images[image], level));
  visit_mip_rows(scene_.images[image], srgb, [&](int level, int, std::span<const glm::vec4> row) {
    if (level == 0) return;
    auto& texels = chain[size_t(level - 1)].texels;
    texels.insert(texels.end(), row.begin(), row.end());
  });
}

glm::vec4 Mipmaps::sample(int texture, glm::vec2 uv, float lod, bool srgb) const {
  const Texture& t = scene_.textures[size_t(texture)];
  const Chain& levels = chains_[srgb ? 1 : 0][size_t(t.image)];
  const glm::vec2 at = wrapped(uv, t.sampler);
  const TextureImage& image = scene_.images[size_t(t.image)];
  const auto level = [&](int k, bool nearest) {
    if (k == 0) {
      const std::uint8_t* const bytes = image.rgba.data();
      const auto width = size_t(image.width);
      return filter_texels(t.sampler, {image.width, image.height}, at, nearest, [&](int x, int y) {
        return decoded_texel(bytes + 4 * (size_t(y) * width + size_t(x)), srgb);
      });
    }
    const MipLevel& l = levels[size_t(k - 1)];
    const glm::vec4* const texels = l.texels.data();
    return filter_texels(t.sampler, {l.width, l.height}, at, nearest,
                         [&](int x, int y) { return texels[size_t(y) * size_t(l.width) + size_t(x)]; });
  };
  if (!(lod > 0.0f)) return level(0, t.sampler.magnify_nearest);
  const bool nearest = t.sampler.minify_nearest;
  if (!t.sampler.mipmap) return level(0, nearest);
  const int coarsest = int(levels.size());
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
