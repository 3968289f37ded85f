#include "screen/base/sky_seen.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "core/gl/raster_state.h"
#include "shaders/screen/base/gbuffer.shared.h"

namespace volgi::screen {
namespace {

gl::Texture upload(const Image& image) {
  const int levels = int(std::bit_width(unsigned(std::max(image.width, image.height))));
  gl::Texture t = gl::Texture::make_2d(GL_RGBA32F, image.width, image.height, levels);
  std::vector<glm::vec4> texels;
  texels.reserve(image.pixels.size());
  for (const glm::vec3& p : image.pixels) texels.emplace_back(p, 1.0f);
  glTextureSubImage2D(t.id(), 0, 0, 0, image.width, image.height, GL_RGBA, GL_FLOAT, texels.data());
  glGenerateTextureMipmap(t.id());
  t.filter(GL_LINEAR_MIPMAP_LINEAR, GL_LINEAR);
  t.wrap(GL_REPEAT, GL_CLAMP_TO_EDGE);
  return t;
}

}  // namespace

SkySeen::SkySeen(const GBuffer& gbuffer)
    : gbuffer_(gbuffer),
      program_(gl::Program::raster("shared/fullscreen.vert.glsl", "screen/base/sky_seen.frag.glsl")) {
  const std::array colors{gl::Framebuffer::Attachment{&gbuffer.emission()}};
  framebuffer_ = gl::Framebuffer(colors, {}, gbuffer.size());
}

void SkySeen::run(const Sky& sky, const Camera& camera, gl::PassTimer& timer) {
  const auto scope = timer.scope(name);
  if (uploaded_ != sky.id()) picture_ = upload(sky.image());
  uploaded_ = sky.id();
  gl::begin_fullscreen_pass();
  framebuffer_.bind();
  gbuffer_.bind();
  picture_.bind(GBUFFER_UNITS);
  const glm::mat3 axes(camera.world_from_camera);
  const bool perspective = camera.kind == Camera::Kind::perspective;
  const float up = perspective ? std::tan(0.5f * camera.yfov_rad) : 0.0f;
  const float aspect = float(gbuffer_.size().x) / float(gbuffer_.size().y);
  program_.set("forward", -axes[2]);
  program_.set("right", axes[0] * (up * aspect));
  program_.set("up", axes[1] * up);
  program_.set("rotation_rad", sky.rotation_rad());
  program_.use();
  gl::draw_fullscreen_triangle();
}

}  // namespace volgi::screen
