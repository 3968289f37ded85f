#include "screen/sources/sky/sky_maps.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/gl/raster_state.h"
#include "core/light_layers.h"
#include "core/log.h"
#include "shaders/screen/sources/sky/slots.shared.h"

namespace volgi::screen {
namespace {

void warn_of_coarse_maps(const Scene& scene, const SceneBox& box, int resolution) {
  constexpr float COARSE_M = 0.5f;  // half of it is more than most walls are thick
  const float texel_m = glm::distance(box.min, box.max) / float(resolution);
  if (texel_m <= COARSE_M) return;
  warn_once(
      fmt::format("{}: the sky's maps have texels of {:.2g} m: its light may pass walls thinner than half of that; "
                  "--set sky.map=N makes more of them",
                  scene.name, double(texel_m)));
}

}  // namespace

SkyMaps::SkyMaps(const SkyOptions& options)
    : resolution_(options.map_texels),
      parts_asked_(options.parts),
      program_(gl::Program::raster("screen/base/reflective_shadow_map.vert.glsl",
                                   "screen/sources/sky/sky_maps.frag.glsl")) {}

void SkyMaps::run(const gl::SceneBuffers& buffers, const Scene& scene, gl::PassTimer& timer, int sample) {
  if (drawn_ == scene.sky && drawn_sample_ == sample) return;
  const auto scope = timer.scope(name);
  if (!drawn_ || drawn_ != scene.sky) sky_.emplace(scene.sky, parts_asked_);
  layers_.clear();
  parts_ = sky_->lights(sample);
  const SceneBox all{scene.bounds_min, scene.bounds_max};
  const std::optional<SceneBox> detail = 2 * parts_.size() <= SKY_MAX_PARTS ? detail_box(scene) : std::nullopt;
  for (const SkyLight& light : parts_) layers_.push_back(layer_across(light.direction, resolution_, all, all));
  for (const SkyLight& light : parts_)
    if (detail) layers_.push_back(layer_across(light.direction, resolution_, *detail, all));
  upload_parts();
  warn_of_coarse_maps(scene, detail.value_or(all), resolution_);
  if (buffers.has_glass() && !glass_) glass_.emplace();
  if (framebuffers_.size() != layers_.size()) make_room();
  gl::begin_geometry_pass();
  for (size_t layer = 0; layer < layers_.size(); ++layer) {
    framebuffers_[layer].bind();
    constexpr std::array nothing{0u, 0u, 0u, 0u};
    constexpr float farthest = 0.0f;
    glClearNamedFramebufferuiv(framebuffers_[layer].id(), GL_COLOR, 0, nothing.data());
    glClearNamedFramebufferfv(framebuffers_[layer].id(), GL_DEPTH, 0, &farthest);
    program_.set("clip_from_world", layers_[layer].clip_from_world);
    program_.set("viewer", glm::vec4(-layers_[layer].forward, 0.0f));
    buffers.draw(program_);
  }
  if (glass_) draw_glass(buffers);
  drawn_ = scene.sky;
  drawn_sample_ = sample;
  ++version_;
}

void SkyMaps::draw_glass(const gl::SceneBuffers& buffers) {
  constexpr std::array nothing{1.0f, 1.0f, 1.0f, 0.0f};
  for (size_t layer = 0; layer < layers_.size(); ++layer) {
    glClearNamedFramebufferfv(through_glass_[layer].id(), GL_COLOR, 0, nothing.data());
    glass_->run(buffers, through_glass_[layer], layers_[layer].clip_from_world);
  }
}

void SkyMaps::make_room() {
  const auto maps = int(layers_.size());
  depth_ = gl::Texture::make_2d_array(GL_DEPTH_COMPONENT32F, resolution_, resolution_, maps);
  surface_ = gl::Texture::make_2d_array(GL_RG32UI, resolution_, resolution_, maps);
  framebuffers_.clear();
  for (int layer = 0; layer < maps; ++layer) {
    using Attachment = gl::Framebuffer::Attachment;
    const std::array colors{Attachment{&surface_, layer}};
    framebuffers_.emplace_back(colors, Attachment{&depth_, layer}, glm::ivec2(resolution_));
  }
  if (!glass_) return;
  tint_ = gl::Texture::make_2d_array(GL_RGBA16F, resolution_, resolution_, maps);
  through_glass_.clear();
  for (int layer = 0; layer < maps; ++layer) {
    using Attachment = gl::Framebuffer::Attachment;
    const std::array colors{Attachment{&tint_, layer}};
    through_glass_.emplace_back(colors, Attachment{&depth_, layer}, glm::ivec2(resolution_));
  }
}

void SkyMaps::upload_parts() {
  std::vector<shared::SkyPart> parts(layers_.size());
  for (size_t k = 0; k < layers_.size(); ++k) {
    const shared::ReflectiveShadowLayer& l = layers_[k];
    const float texels = float(resolution_);
    const auto linear = [&](glm::vec3 axis, float offset) {
      return glm::vec4(axis, float(double(offset) - glm::dot(glm::dvec3(axis), glm::dvec3(l.origin))));
    };
    parts[k].column = linear(l.right * (0.5f * texels / l.extent_x), 0.5f * texels);
    parts[k].row = linear(l.up * (0.5f * texels / l.extent_y), 0.5f * texels);
    parts[k].way = linear(l.forward, 0.0f);
    parts[k].light = glm::vec4(parts_[k % parts_.size()].irradiance, l.depth_scale_m);
  }
  const GLuint before = part_buffer_.id();
  gl::put(part_buffer_, parts);
  if (part_buffer_.id() != before) part_texels_ = gl::Texture::view_of(part_buffer_, GL_RGBA32F, sizeof(glm::vec4));
}

void SkyMaps::bind(const gl::Program& program) const {
  part_texels_.bind(SKY_PARTS_UNIT);
  surface_.bind(SKY_SURFACE_UNIT);
  if (glass_) tint_.bind(SKY_TINT_UNIT);
  program.set("sky_glass", glass_ ? 1 : 0);
  program.set("sky_detailed", detailed() ? 1 : 0);
  program.set("sky_resolution", resolution_);
  program.set("part_count", part_count());
}

size_t SkyMaps::bytes() const {
  return (glass_ ? 20 : 12) * size_t(resolution_) * size_t(resolution_) * layers_.size() + part_buffer_.bytes();
}

}  // namespace volgi::screen
