#include "screen/base/reflective_shadow_map.h"

#include <cassert>

#include "core/gl/limits.h"
#include "core/gl/raster_state.h"
#include "core/light.h"

namespace volgi::screen {

ReflectiveShadowMap::ReflectiveShadowMap(Resolution resolution, GLenum normal_format)
    : resolution_(resolution),
      normal_format_(gl::renderable_format(normal_format, GL_RG32F)),
      program_(gl::Program::raster(name)) {}

ReflectiveShadowMap::Map ReflectiveShadowMap::make_map(int resolution, int layer_count) const {
  Map map;
  map.depth = gl::Texture::make_2d_array(GL_DEPTH_COMPONENT32F, resolution, resolution, layer_count);
  map.normal = gl::Texture::make_2d_array(normal_format_, resolution, resolution, layer_count);
  map.albedo = gl::Texture::make_2d_array(GL_RGBA16, resolution, resolution, layer_count);
  for (int layer = 0; layer < layer_count; ++layer) {
    using Attachment = gl::Framebuffer::Attachment;
    const std::array colors{Attachment{&map.normal, layer}, Attachment{&map.albedo, layer}};
    map.framebuffers.emplace_back(colors, Attachment{&map.depth, layer}, glm::ivec2(resolution));
  }
  if (!glass_) return map;
  map.tint = gl::Texture::make_2d_array(GL_RGBA16F, resolution, resolution, layer_count);
  for (int layer = 0; layer < layer_count; ++layer) {
    using Attachment = gl::Framebuffer::Attachment;
    const std::array colors{Attachment{&map.albedo, layer}, Attachment{&map.tint, layer}};
    map.through_glass.emplace_back(colors, Attachment{&map.depth, layer}, glm::ivec2(resolution));
  }
  return map;
}

void ReflectiveShadowMap::run(const gl::SceneBuffers& buffers, const Scene& scene, gl::PassTimer& timer) {
  const auto scope = timer.scope(name);
  if (buffers.has_glass() && !glass_) glass_.emplace();
  lights_.clear();
  layers_.clear();
  maps_.resize(scene.lights.size());
  for (size_t i = 0; i < scene.lights.size(); ++i) {
    const Light& light = scene.lights[i];
    int resolution = light.type == Light::Type::directional ? resolution_.sun : resolution_.spot;
    auto layers = reflective_shadow_layers(light, resolution, scene.bounds_min, scene.bounds_max);
    if (layers.size() > 1) {
      resolution = resolution_.cube_face;
      layers = reflective_shadow_layers(light, resolution, scene.bounds_min, scene.bounds_max);
    }
    lights_.push_back({to_shared(light), int(layers_.size()), int(layers.size()), resolution, 0});
    layers_.insert(layers_.end(), layers.begin(), layers.end());
    const glm::ivec3 size(resolution, resolution, int(layers.size()));
    if (maps_[i].framebuffers.empty() || maps_[i].depth.size() != size) maps_[i] = make_map(size.x, size.z);
  }
  gl::put(light_buffer_, lights_);
  gl::put(layer_buffer_, layers_);

  gl::begin_geometry_pass();
  for (int light = 0; light < light_count(); ++light) {
    for (int layer = 0; layer < layer_count(light); ++layer) draw_layer(buffers, maps_[size_t(light)], light, layer);
  }
  if (glass_) draw_glass(buffers);
}

void ReflectiveShadowMap::draw_glass(const gl::SceneBuffers& buffers) {
  constexpr std::array nothing{1.0f, 1.0f, 1.0f, 0.0f};
  for (size_t light = 0; light < maps_.size(); ++light) {
    for (size_t layer = 0; layer < maps_[light].through_glass.size(); ++layer) {
      const gl::Framebuffer& target = maps_[light].through_glass[layer];
      glClearNamedFramebufferfv(target.id(), GL_COLOR, 1, nothing.data());
      glass_->run(buffers, target, layers_[size_t(lights_[light].first_layer) + layer].clip_from_world);
    }
  }
}

void ReflectiveShadowMap::draw_layer(const gl::SceneBuffers& buffers, const Map& map, int light, int layer) {
  const shared::ReflectiveShadowLayer& view = layers_[size_t(lights_[size_t(light)].first_layer) + size_t(layer)];
  const gl::Framebuffer& target = map.framebuffers[size_t(layer)];
  target.bind();
  constexpr std::array zero{0.0f, 0.0f, 0.0f, 0.0f};
  for (GLint i = 0; i < 2; ++i) glClearNamedFramebufferfv(target.id(), GL_COLOR, i, zero.data());
  glClearNamedFramebufferfv(target.id(), GL_DEPTH, 0, zero.data());
  program_.set("clip_from_world", view.clip_from_world);
  program_.set("viewer", view.directional != 0 ? glm::vec4(-view.forward, 0.0f) : glm::vec4(view.origin, 1.0f));
  buffers.draw(program_);
}

void ReflectiveShadowMap::bind(int light) const {
  assert(light >= 0 && light < light_count());
  const Map& map = maps_[size_t(light)];
  light_buffer_.bind_storage(RSM_LIGHTS_SLOT);
  layer_buffer_.bind_storage(RSM_LAYERS_SLOT);
  map.depth.bind(RSM_DEPTH_UNIT);
  map.normal.bind(RSM_NORMAL_UNIT);
  map.albedo.bind(RSM_ALBEDO_UNIT);
  if (glass_) map.tint.bind(RSM_TINT_UNIT);
}

size_t ReflectiveShadowMap::bytes() const {
  size_t sum = light_buffer_.bytes() + layer_buffer_.bytes();
  const size_t texel_bytes = (normal_format_ == GL_RG16_SNORM ? 16 : 20) + (glass_ ? 8 : 0);
  for (const shared::ReflectiveShadowLight& l : lights_) {
    sum += size_t(l.layer_count) * size_t(l.resolution) * size_t(l.resolution) * texel_bytes;
  }
  return sum;
}

void ReflectiveShadowMap::list_textures(std::vector<NamedTexture>& list) const {
  for (size_t light = 0; light < maps_.size(); ++light) {
    const std::string of_light = std::string(name) + " light " + std::to_string(light);
    list_texture(list, of_light, "depth", maps_[light].depth);
    list_texture(list, of_light, "normals", maps_[light].normal);
    list_texture(list, of_light, "albedo", maps_[light].albedo);
    list_texture(list, of_light, "tint of glass", maps_[light].tint);
  }
}

}  // namespace volgi::screen
