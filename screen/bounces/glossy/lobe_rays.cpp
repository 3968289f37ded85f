#include "screen/bounces/glossy/lobe_rays.h"

#include <algorithm>

#include "shaders/screen/bounces/glossy/slots.shared.h"
#include "shaders/shared/group_sizes.shared.h"
#include "shaders/shared/virtual_light.shared.h"

namespace volgi::screen {

namespace {

gl::Texture picture(glm::ivec2 size) { return gl::Texture::make_2d(GL_RGBA32F, size.x, size.y); }

}  // namespace

LobeRays::LobeRays(glm::ivec2 size, const GlossyOptions& options, bool phong)
    : size_(size),
      options_(options),
      direct_(picture(size)),
      indirect_(picture(size)),
      half_direct_(picture(size)),
      half_indirect_(picture(size)),
      counts_(2 * sizeof(GLuint)),
      no_lights_(sizeof(shared::VirtualLight)),
      light_sides_program_(gl::Program::compute("screen/bounces/glossy/light_sides.comp.glsl")),
      rays_(gl::Program::compute("screen/bounces/glossy/lobe_rays.comp.glsl",
                                 phong ? std::vector<std::string>{"PHONG"} : std::vector<std::string>{})),
      join_(gl::Program::compute("screen/bounces/glossy/join_lobes.comp.glsl")) {}

void LobeRays::run(const GBuffer& gbuffer, const Camera& camera, const Seen& seen, gl::PassTimer& timer, int sample) {
  gbuffer.bind();
  gbuffer.bind_shine();
  {
    const auto scope = timer.scope(name);
    find_lights(seen);
    trace(camera, seen, sample);
  }
  const auto scope = timer.scope(join_name);
  join();
}

void LobeRays::find_lights(const Seen& seen) {
  const int count = seen.lights != nullptr ? seen.lights->count() : 0;
  gl::reserve(light_sides_, sizeof(float) * size_t(std::max(count, 1)));
  light_sides_.bind_storage(GLOSSY_LIGHT_SIDES_SLOT);
  (seen.lights != nullptr ? seen.lights->buffer() : no_lights_).bind_storage(GLOSSY_LIGHTS_SLOT);
  seen.voxels.bind();
  if (count == 0) return;
  light_sides_program_.set("light_count", count);
  light_sides_program_.use();
  gl::dispatch_linear(size_t(count), LINEAR_GROUP);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

void LobeRays::trace(const Camera& camera, const Seen& seen, int sample) {
  counts_.clear();
  counts_.bind_storage(GLOSSY_COUNTS_SLOT);
  cells_.bind(seen.voxels);
  seen.radiosity.bind_storage(GLOSSY_RADIOSITY_SLOT);
  if (seen.sky != nullptr) seen.sky->picture().bind(GLOSSY_SKY_UNIT);
  direct_.bind_image(GLOSSY_DIRECT_IMAGE, GL_WRITE_ONLY);
  indirect_.bind_image(GLOSSY_INDIRECT_IMAGE, GL_WRITE_ONLY);
  const bool perspective = camera.kind == Camera::Kind::perspective;
  rays_.set("viewer", perspective ? camera.world_from_camera[3] : camera.world_from_camera[2]);
  rays_.set("rays", options_.rays);
  rays_.set("interleave", options_.interleave);
  rays_.set("first_point", 1 + sample * options_.rays * options_.interleave * options_.interleave);
  rays_.set("least_roughness", options_.least_roughness);
  rays_.set("light_count", seen.lights != nullptr ? seen.lights->count() : 0);
  rays_.set("lights_per_watt", seen.lights != nullptr ? seen.lights->lights_per_watt() : 0.0f);
  rays_.set("lights_per_m2", seen.lights != nullptr ? seen.lights->lights_per_m2() : 0.0f);
  rays_.set("has_sky", seen.sky != nullptr ? 1 : 0);
  rays_.set("sky_rotation_rad", seen.sky_rotation_rad);
  rays_.use();
  gl::dispatch({size_.x, size_.y, 1}, {SQUARE_GROUP, SQUARE_GROUP, 1});
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
}

void LobeRays::join() {
  if (options_.interleave == 1) return;
  join_.set("interleave", options_.interleave);
  join_.use();
  const auto along = [&](glm::ivec2 axis, const gl::Texture* from, const gl::Texture* from_indirect,
                         const gl::Texture* to, const gl::Texture* to_indirect) {
    from->bind(GLOSSY_DIRECT_UNIT);
    from_indirect->bind(GLOSSY_INDIRECT_UNIT);
    to->bind_image(GLOSSY_DIRECT_IMAGE, GL_WRITE_ONLY);
    to_indirect->bind_image(GLOSSY_INDIRECT_IMAGE, GL_WRITE_ONLY);
    join_.set("axis", axis);
    gl::dispatch({size_.x, size_.y, 1}, {SQUARE_GROUP, SQUARE_GROUP, 1});
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
  };
  along({1, 0}, &direct_, &indirect_, &half_direct_, &half_indirect_);
  along({0, 1}, &half_direct_, &half_indirect_, &direct_, &indirect_);
}

LobeRays::Shares LobeRays::shares() const {
  const std::vector<GLuint> counts = counts_.download<GLuint>(2);
  const double pixels = double(size_.x) * double(size_.y);
  return {double(counts[0]) / pixels, double(counts[1]) / std::max(double(counts[0]), 1.0)};
}

}  // namespace volgi::screen
