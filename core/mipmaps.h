#pragma once
#include <functional>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "core/scene.h"

namespace volgi {

/// One level of a texture, linear light, row 0 first.
struct MipLevel {
  int width = 0, height = 0;
  std::vector<glm::vec4> texels;  // RGBA in [0,1]
};

/// The texture and its coarser levels down to one texel: level k has half the edge of level k-1, rounded down, at least
/// 1, filtered in linear light. What both twins sample: SceneBuffers uploads it, because drivers' own mipmaps are kept
/// in 8 bits and grow darker from level to level (llvmpipe: 1 % over four).
std::vector<MipLevel> mip_chain(const TextureImage& image, bool srgb);
/// The same without keeping it: visit(level, y, row) for every row of every level, those of a level in their order.
/// Memory: three rows a level.
void visit_mip_rows(const TextureImage& image, bool srgb,
                    const std::function<void(int, int, std::span<const glm::vec4>)>& visit);
/// Levels down to one texel.
int mip_count(const TextureImage& image);

/// Coarser levels of a scene's textures, for sampling surfaces at a distance (a voxel's) without aliasing. Twin of
/// what GL samples.
/// Memory: a third of the textures' size as floats, for textures that are used as colours and as data apart; the
/// textures themselves are looked at where they are.
class Mipmaps {
 public:
  /// Makes no levels yet; prepare() those that will be sampled. The scene must outlive this.
  explicit Mipmaps(const Scene& scene);
  /// Not thread-safe; sample() is.
  void prepare(int texture, bool srgb);

  /// RGBA in linear light at level of detail `lod` (0: the texture itself; fractions between two levels), filtered as
  /// the texture's sampler says. The texture must have been prepared.
  glm::vec4 sample(int texture, glm::vec2 uv, float lod, bool srgb) const;

  size_t bytes() const;

 private:
  using Chain = std::vector<MipLevel>;

  const Scene& scene_;
  std::vector<Chain> chains_[2];  // by image, from level 1 on; data, colours
};

}  // namespace volgi
