#include "screen/gather/subsplats/upsample.h"

#include "shaders/screen/gather/subsplats/slots.shared.h"
#include "shaders/shared/group_sizes.shared.h"

namespace volgi::screen {

namespace {

std::vector<std::string> defines(const UpsampleOptions& options, bool to_pixels) {
  std::vector<std::string> all;
  if (options.rendered == UpsampleOptions::Rendered::kept) all.emplace_back("KEEP_RENDERED");
  if (to_pixels) all.emplace_back("TO_PIXELS");
  return all;
}

constexpr const char* SHADER = "screen/gather/subsplats/upsample.comp.glsl";

}  // namespace

Upsample::Upsample(const SubsplatLevels& levels, const UpsampleOptions& options)
    : levels_(levels),
      options_(options),
      upsampled_(gl::Texture::make_2d(GL_RGBA32F, levels.tower().x, levels.tower().y)),
      radiance_(gl::Texture::make_2d(GL_RGBA32F, levels.size.x, levels.size.y)),
      level_(gl::Program::compute(SHADER, defines(options, false))),
      pixels_(gl::Program::compute(SHADER, defines(options, true))) {}

void Upsample::run(const GBuffer& gbuffer, const Camera& camera, const gl::Texture& rendered, gl::PassTimer& timer) {
  const auto scope = timer.scope(name);
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
  gbuffer.bind();
  rendered.bind(RENDERED_UNIT);
  upsampled_.bind(COARSER_UNIT);
  const bool perspective = camera.kind == Camera::Kind::perspective;
  pixels_.set("viewer", perspective ? camera.world_from_camera[3] : camera.world_from_camera[2]);
  pixels_.set("detail", options_.detail);
  upsampled_.bind_image(UPSAMPLED_IMAGE, GL_WRITE_ONLY);
  for (const gl::Program* program : {&level_, &pixels_}) levels_.set(*program);
  for (int level = levels_.last; level >= 0; --level) {
    const gl::Program& program = level > 0 ? level_ : pixels_;
    if (level == 0) radiance_.bind_image(UPSAMPLED_IMAGE, GL_WRITE_ONLY);
    const glm::ivec2 size = shared::level_size(levels_.size, level);
    program.set("level", level);
    program.use();
    gl::dispatch({size.x, size.y, 1}, {SQUARE_GROUP, SQUARE_GROUP, 1});
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
  }
}

size_t Upsample::bytes() const {
  return 16 * (size_t(levels_.tower().x) * size_t(levels_.tower().y) + size_t(levels_.size.x) * size_t(levels_.size.y));
}

}  // namespace volgi::screen
