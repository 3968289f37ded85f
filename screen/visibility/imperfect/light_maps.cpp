#include "screen/visibility/imperfect/light_maps.h"

#include <algorithm>

#include "shaders/screen/base/slots.shared.h"
#include "shaders/screen/visibility/area_maps/slots.shared.h"
#include "shaders/screen/visibility/imperfect/slots.shared.h"
#include "shaders/shared/group_sizes.shared.h"

namespace volgi::screen {

namespace {

constexpr int kLayerTexels = 1024;  // on a side of a layer of imperfect maps

}  // namespace

LightMaps::LightMaps(const Scene& scene, VisibilityChoice::Maps maps, const ImperfectMapOptions& options)
    : regular_count_(options.regular_count),
      texels_(options.regular_texels),
      views_program_(gl::Program::compute("screen/visibility/imperfect/map_views.comp.glsl")) {
  if (maps == VisibilityChoice::Maps::regular) return;
  imperfect_.emplace(scene, options);
  texels_ = imperfect_->texels();
}

void LightMaps::follow(const Scene& scene) {
  if (imperfect_) imperfect_->follow(scene);
}

/// Room for the maps of as many lights.
void LightMaps::lay_out(const VirtualLightListGl& lights) {
  const int sides = lights.in_the_air ? 2 : 1;
  if (lights.count() == lights_ && sides == sides_ && views_.id() != 0) return;
  lights_ = lights.count();
  sides_ = sides;
  mapped_ = imperfect_ ? lights_ : std::min({lights_, regular_count_, MAX_VIRTUAL_AREA_LIGHTS / sides});
  views_ = gl::Buffer(size_t(std::max(maps(), 1)) * sizeof(shared::VirtualAreaLight));
  if (mapped_ == 0) return;
  if (!imperfect_) {
    tiles_ = 1;
    regular_ = std::make_unique<ParaboloidDepthMaps>(texels_, maps());
    return;
  }
  tiles_ = kLayerTexels / texels_;
  const int layers = (maps() + tiles_ * tiles_ - 1) / (tiles_ * tiles_);
  distances_ = gl::Texture::make_2d_array(GL_R32F, kLayerTexels, kLayerTexels, layers);
}

void LightMaps::make_views(const VirtualLightListGl& lights) const {
  views_program_.set("lights", lights_);
  views_program_.set("mapped", mapped_);
  views_program_.set("sides", sides_);
  lights.buffer.bind_storage(VIRTUAL_LIGHTS_SLOT);
  views_.bind_storage(MAP_VIEWS_SLOT);
  views_program_.use();
  gl::dispatch_linear(size_t(maps()), LINEAR_GROUP);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

void LightMaps::run(const gl::SceneBuffers& triangles, const VirtualLightListGl& lights, float scene_diagonal_m,
                    gl::PassTimer& timer) {
  lay_out(lights);
  if (mapped_ == 0) return;
  {
    const auto scope = timer.scope(views_name);
    make_views(lights);
  }
  if (imperfect_) {
    imperfect_->run(views_, maps(), distances_, tiles_, scene_diagonal_m, timer);
  } else {
    regular_->run(triangles, views_, maps(), timer);
  }
}

void LightMaps::bind(const gl::Program& program) const {
  program.set("map_lights", std::max(lights_, 1));
  program.set("map_mapped", mapped_);
  program.set("map_sides", sides_);
  program.set("map_texels", texels_);
  program.set("map_tiles", tiles_);
  if (mapped_ > 0) distances().bind(SHADOW_DISTANCE_UNIT);
}

size_t LightMaps::bytes() const {
  size_t bytes = views_.bytes() + (imperfect_ ? imperfect_->bytes() : 0) + (regular_ ? regular_->bytes() : 0);
  const glm::ivec3 size = distances_.size();
  return bytes + sizeof(float) * size_t(size.x) * size_t(size.y) * size_t(size.z);
}

void LightMaps::list_textures(std::vector<NamedTexture>& list) const {
  if (mapped_ == 0) return;
  list_texture(list, imperfect_ ? ImperfectMaps::name : ParaboloidDepthMaps::name, "distance", distances());
}

}  // namespace volgi::screen
