#include "screen/gather/interleaved/near_lights.h"

#include <algorithm>
#include <array>

#include "shaders/screen/gather/interleaved/near_tiles.shared.h"
#include "shaders/screen/gather/interleaved/slots.shared.h"
#include "shaders/shared/disk_to_point.shared.h"
#include "shaders/shared/group_sizes.shared.h"

namespace volgi::screen {

namespace {

glm::ivec2 tiles_of(glm::ivec2 pixels, int tile) { return (pixels + tile - 1) / tile; }

std::vector<std::string> defines(float zone) {
  return zone >= DISK_FAR_AREAS ? std::vector<std::string>{"FROM_AFAR"} : std::vector<std::string>{};
}

}  // namespace

NearLights::NearLights(glm::ivec2 size, float zone)
    : size_(size),
      zone_(zone),
      direct_(gl::Texture::make_2d(GL_RGBA32F, size.x, size.y)),
      indirect_(gl::Texture::make_2d(GL_RGBA32F, size.x, size.y)),
      boxes_program_(gl::Program::compute("screen/gather/interleaved/near_lights_boxes.comp.glsl")),
      large_program_(gl::Program::compute("screen/gather/interleaved/near_lights_tiles.comp.glsl", {"LARGE"})),
      tiles_program_(gl::Program::compute("screen/gather/interleaved/near_lights_tiles.comp.glsl")),
      gather_(gl::Program::compute("screen/gather/interleaved/near_lights.comp.glsl", defines(zone))) {
  direct_.clear({0.0f, 0.0f, 0.0f, 0.0f});
}

void NearLights::find_tiles(const GBuffer& gbuffer, const VirtualLightListGl& lights,
                            const VirtualLightSubdivision& subdivision, gl::PassTimer& timer) {
  const auto scope = timer.scope(tiles_name);
  const auto words = size_t(lights.count() + 31) / 32;
  const glm::ivec2 large = tiles_of(size_, NEAR_TILE * LARGE_TILE), small = tiles_of(size_, NEAR_TILE);
  const size_t large_count = size_t(large.x) * size_t(large.y), small_count = size_t(small.x) * size_t(small.y);
  list_.reserve(small_count);
  gl::reserve(boxes_, small_count * 2 * sizeof(glm::vec4));
  gl::reserve(masks_, small_count * words * sizeof(GLuint));
  gl::reserve(large_masks_, large_count * words * sizeof(GLuint));
  list_.clear();
  subdivision.near_lights().bind_storage(NEAR_LIGHTS_SLOT);
  list_.bind(NEAR_TILES_SLOT);
  masks_.bind_storage(TILE_MASKS_SLOT);
  large_masks_.bind_storage(LARGE_MASKS_SLOT);
  boxes_.bind_storage(TILE_BOXES_SLOT);
  gbuffer.bind();
  const auto run = [&](const gl::Program& program, size_t threads) {
    program.set("tiles", small);
    program.set("words", int(words));
    program.set("zone", zone_);
    program.set("apart", subdivision.apart() ? 1 : 0);
    program.set("light_count", lights.count());
    program.use();
    gl::dispatch_linear(threads, LINEAR_GROUP);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  };
  run(boxes_program_, small_count);
  run(large_program_, large_count * words);
  run(tiles_program_, small_count);
}

void NearLights::run(const GBuffer& gbuffer, const VirtualLightListGl& lights,
                     const VirtualLightSubdivision& subdivision, gl::PassTimer& timer) {
  find_tiles(gbuffer, lights, subdivision, timer);
  const auto scope = timer.scope(name);
  indirect_.clear({0.0f, 0.0f, 0.0f, 0.0f});
  if (lights.emitted > 0) direct_.clear({0.0f, 0.0f, 0.0f, 0.0f});
  gather_.set("tiles", tiles_of(size_, NEAR_TILE));
  gather_.set("words", (lights.count() + 31) / 32);
  gather_.set("zone", zone_);
  gather_.set("apart", subdivision.apart() ? 1 : 0);
  gather_.set("first_emitted", lights.reflected);
  gather_.set("with_direct", lights.emitted > 0 ? 1 : 0);
  subdivision.near_lights().bind_storage(NEAR_LIGHTS_SLOT);
  list_.bind(NEAR_TILES_SLOT);
  masks_.bind_storage(TILE_MASKS_SLOT);
  subdivision.sublights().bind_storage(NEAR_SUBLIGHTS_SLOT);
  gbuffer.bind();
  indirect_.bind_image(INDIRECT_IMAGE, GL_WRITE_ONLY);
  direct_.bind_image(DIRECT_IMAGE, GL_WRITE_ONLY);
  gather_.use();
  list_.dispatch();
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
}

size_t NearLights::bytes() const {
  return list_.bytes() + boxes_.bytes() + masks_.bytes() + large_masks_.bytes() +
         2 * 16 * size_t(size_.x) * size_t(size_.y);
}

}  // namespace volgi::screen
