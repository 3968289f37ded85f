#include "screen/base/compose.h"

#include <algorithm>
#include <array>
#include <string>

#include "core/error.h"
#include "core/gl/raster_state.h"

namespace volgi::screen {

Compose::Compose(glm::ivec2 size)
    : radiance_(gl::Texture::make_2d(GL_RGBA32F, size.x, size.y)),
      program_(gl::Program::raster("shared/fullscreen.vert.glsl", "screen/base/compose.frag.glsl")) {
  const std::array colors{gl::Framebuffer::Attachment{&radiance_}};
  framebuffer_ = gl::Framebuffer(colors, {}, size);
}

void Compose::run(const GBuffer& gbuffer, std::span<const gl::Texture* const> layers, const gl::Texture* background,
                  gl::PassTimer& timer, const gl::SceneBuffers* scene) {
  const auto scope = timer.scope(name);
  if (layers.size() > MAX_LAYERS) {
    throw Error(ExitCode::over_limit, "a picture of " + std::to_string(layers.size()) + " layers: at most " +
                                          std::to_string(MAX_LAYERS) + " can be summed; use a recipe of fewer stages");
  }
  gl::begin_fullscreen_pass();
  framebuffer_.bind();
  gbuffer.bind();
  for (size_t i = 0; i < layers.size(); ++i) layers[i]->bind(GLuint(COMPOSE_LAYERS_UNIT + i));
  program_.use();
  program_.set("layer_count", int(layers.size()));
  const auto behind = std::find(layers.begin(), layers.end(), background);
  program_.set("background_layer", behind == layers.end() ? -1 : int(behind - layers.begin()));
  gl::draw_fullscreen_triangle();
  if (scene == nullptr || !scene->has_glass()) return;
  if (!glass_) {
    glass_.emplace();
    const std::array colors{gl::Framebuffer::Attachment{&radiance_}};
    through_glass_ = gl::Framebuffer(colors, {&gbuffer.depth()}, radiance_.size());
  }
  glass_->run(*scene, through_glass_, gbuffer.clip_from_world());
}

}  // namespace volgi::screen
