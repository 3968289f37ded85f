#include "screen/gather/interleaved/near_lights.h"

#include <algorithm>
#include <array>

namespace volgi::screen {

namespace {

constexpr int kTile = 8;   // NEAR_TILE of shaders/screen/gather/interleaved/near_lights.glsl
constexpr int kLarge = 4;  // tiles on a side of a large one

glm::ivec2 tiles_of(glm::ivec2 pixels, int tile) { return (pixels + tile - 1) / tile; }

}  // namespace

NearLights::NearLights(glm::ivec2 size, float zone)
    : size_(size),
      zone_(zone),
      direct_(gl::Texture::make_2d(GL_RGBA32F, size.x, size.y)),
      indirect_(gl::Texture::make_2d(GL_RGBA32F, size.x, size.y)),
      tiles_(gl::Program::compute("screen/gather/interleaved/near_lights_tiles.comp.glsl")),
      gather_(gl::Program::compute("screen/gather/interleaved/near_lights.comp.glsl")) {
  direct_.clear({0.0f, 0.0f, 0.0f, 0.0f});
}

void NearLights::find_tiles(const GBuffer& gbuffer, const VirtualLightListGl& lights, const VirtualLightParts& parts,
                            gl::PassTimer& timer) {
  const auto scope = timer.scope(tiles_name);
  const int words = (lights.count() + 31) / 32;
  const glm::ivec2 large = tiles_of(size_, kTile * kLarge), small = tiles_of(size_, kTile);
  const auto mask_bytes = [&](glm::ivec2 tiles) {
    return std::max<size_t>(size_t(tiles.x) * size_t(tiles.y) * size_t(words), 1) * sizeof(GLuint);
  };
  constexpr std::array<GLuint, 4> nothing{0, 1, 1, 0};
  gl::reserve(list_, sizeof nothing + size_t(small.x) * size_t(small.y) * sizeof(GLuint));
  gl::reserve(masks_, mask_bytes(small));
  gl::reserve(large_masks_, mask_bytes(large));
  list_.upload(nothing.data(), sizeof nothing);
  tiles_.set("words", words);
  tiles_.set("zone", zone_);
  tiles_.set("light_count", lights.count());
  tiles_.set("large_columns", large.x);
  parts.near_lights().bind_storage(0);
  list_.bind_storage(1);
  large_masks_.bind_storage(4);
  gbuffer.bind();
  tiles_.use();
  const auto find = [&](glm::ivec2 tiles, int tile_size, int large_tiles, const gl::Buffer& masks) {
    tiles_.set("tiles", tiles);
    tiles_.set("tile_size", tile_size);
    tiles_.set("large_tiles", large_tiles);
    masks.bind_storage(2);
    gl::dispatch({tiles.x * tiles.y, 1, 1}, {64, 1, 1});
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);
  };
  find(large, kTile * kLarge, 0, large_masks_);
  find(small, kTile, kLarge, masks_);
}

void NearLights::run(const GBuffer& gbuffer, const VirtualLightListGl& lights, const VirtualLightParts& parts,
                     gl::PassTimer& timer) {
  find_tiles(gbuffer, lights, parts, timer);
  const auto scope = timer.scope(name);
  indirect_.clear({0.0f, 0.0f, 0.0f, 0.0f});
  if (lights.emitted > 0) direct_.clear({0.0f, 0.0f, 0.0f, 0.0f});
  gather_.set("tiles", tiles_of(size_, kTile));
  gather_.set("words", (lights.count() + 31) / 32);
  gather_.set("zone", zone_);
  gather_.set("first_emitted", lights.reflected);
  gather_.set("with_direct", lights.emitted > 0 ? 1 : 0);
  parts.near_lights().bind_storage(0);
  list_.bind_storage(1);
  masks_.bind_storage(2);
  parts.pieces().bind_storage(3);
  gbuffer.bind();
  indirect_.bind_image(0, GL_WRITE_ONLY);
  direct_.bind_image(1, GL_WRITE_ONLY);
  gather_.use();
  glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, list_.id());
  glDispatchComputeIndirect(0);
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
}

size_t NearLights::bytes() const {
  return list_.bytes() + masks_.bytes() + large_masks_.bytes() + 2 * 16 * size_t(size_.x) * size_t(size_.y);
}

}  // namespace volgi::screen
