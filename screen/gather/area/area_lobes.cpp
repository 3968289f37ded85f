#include "screen/gather/area/area_lobes.h"

#include <algorithm>
#include <bit>

#include "shaders/screen/gather/area/emission_panel.shared.h"
#include "shaders/screen/gather/area/slots.shared.h"
#include "shaders/shared/group_sizes.shared.h"

namespace volgi::screen {

namespace {

constexpr int LAYER_TEXELS = 2 * PANEL_TEXELS;

gl::Texture picture(glm::ivec2 size, GLenum format) { return gl::Texture::make_2d(format, size.x, size.y); }

std::vector<std::string> lobes(bool phong) {
  return phong ? std::vector<std::string>{"PHONG"} : std::vector<std::string>{};
}

/// Of a vector in the plane of both, how much of `along` it is.
glm::vec3 part_along(glm::vec3 along, glm::vec3 other, glm::vec3 normal) {
  const glm::vec3 across = glm::cross(other, normal);
  return across / glm::dot(across, along);
}

}  // namespace

AreaLobes::AreaLobes(glm::ivec2 size, const AreaLobeOptions& options, bool phong)
    : size_(size),
      options_(options),
      phong_(phong),
      kinds_(picture(size, GL_R8UI)),
      radiance_(picture(size, GL_RGBA32F)),
      pictures_(gl::Texture::make_2d_array(GL_RGBA32F, LAYER_TEXELS, LAYER_TEXELS, PANELS_MOST,
                                           int(std::bit_width(unsigned(LAYER_TEXELS))))),
      panels_(PANELS_MOST * sizeof(shared::EmissionPanel)),
      blur_(gl::Program::compute("screen/gather/area/lobe_blur.comp.glsl", lobes(phong))),
      shade_(gl::Program::compute("screen/gather/area/lobe_shade.comp.glsl", lobes(phong))) {
  for (Ways* ways : {&ways_, &along_rows_}) {
    for (gl::Texture& part : ways->parts) part = picture(size, GL_RGBA32F);
  }
  pictures_.filter(GL_LINEAR_MIPMAP_LINEAR, GL_LINEAR);
}

void AreaLobes::scene_moved() {
  panel_count_ = -1;
  cells_.forget();
}

void AreaLobes::show_panels(const EmitterPoints& emitters) {
  if (panel_count_ >= 0) return;
  const std::vector<EmitterPanel> found = emitters.panels(PANEL_TEXELS, PANELS_MOST);
  panel_count_ = int(found.size());
  std::vector<shared::EmissionPanel> panels;
  for (const EmitterPanel& p : found) {
    panels.push_back({p.corner, glm::length(glm::cross(p.along_u, p.along_v)),
                      part_along(p.along_u, p.along_v, p.normal), 0.0f, part_along(p.along_v, p.along_u, p.normal),
                      0.0f, p.normal, 0.0f});
    constexpr int FIRST = PANEL_TEXELS / 2;
    glTextureSubImage3D(pictures_.id(), 0, FIRST, FIRST, int(panels.size()) - 1, PANEL_TEXELS, PANEL_TEXELS, 1, GL_RGB,
                        GL_FLOAT, p.radiance.data());
  }
  if (panels.empty()) return;
  panels_.upload(panels.data(), panels.size() * sizeof(shared::EmissionPanel));
  glGenerateTextureMipmap(pictures_.id());
}

void AreaLobes::run(const GBuffer& gbuffer, const Camera& camera, const AreaLights& lights, const AreaGather& gather,
                    const AreaGather::Hidden& hidden, gl::PassTimer& timer) {
  const bool perspective = camera.kind == Camera::Kind::perspective;
  viewer_ = perspective ? camera.world_from_camera[3] : camera.world_from_camera[2];
  gbuffer.bind();
  gbuffer.bind_shine();
  {
    const auto scope = timer.scope(ways_name);
    show_panels(lights.emitters());
    find_ways(lights, hidden);
  }
  if (options_.variance && panel_count_ > 0) {
    const auto scope = timer.scope(blur_name);
    blur({1, 0}, ways_, along_rows_);
    blur({0, 1}, along_rows_, ways_);
  }
  const auto scope = timer.scope(name);
  shade(lights, gather);
}

void AreaLobes::set_receiver(const gl::Program& program, const AreaLights& lights) const {
  lights.buffer().bind_storage(AREA_LIGHTS_SLOT);
  panels_.bind_storage(AREA_PANELS_SLOT);
  program.set("panel_count", panel_count_);
  program.set("viewer", viewer_);
  program.set("light_count", lights.count());
}

void AreaLobes::find_ways(const AreaLights& lights, const AreaGather::Hidden& hidden) {
  const std::string hides = hidden.voxels != nullptr ? "VOXELS" : hidden.faces != nullptr ? "FACES" : "NOTHING";
  if (hides_ != hides) {
    hides_ = hides;
    std::vector<std::string> defines = lobes(phong_);
    defines.push_back(hides);
    find_ways_ = gl::Program::compute("screen/gather/area/lobe_ways.comp.glsl", defines);
  }
  if (hidden.voxels != nullptr) hidden.voxels->bind(find_ways_);
  if (hidden.faces != nullptr) {
    hidden.faces->voxels.bind();
    cells_.bind(hidden.faces->voxels);
  }
  set_receiver(find_ways_, lights);
  kinds_.bind_image(AREA_LOBE_KIND_IMAGE, GL_WRITE_ONLY);
  for (GLuint k = 0; k < 3; ++k) ways_.parts[k].bind_image(AREA_LOBE_WAYS_IMAGE + k, GL_WRITE_ONLY);
  find_ways_.use();
  gl::dispatch({size_.x, size_.y, 1}, {SQUARE_GROUP, SQUARE_GROUP, 1});
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
}

void AreaLobes::blur(glm::ivec2 axis, const Ways& from, const Ways& to) const {
  kinds_.bind(AREA_LOBE_KIND_UNIT);
  for (GLuint k = 0; k < 3; ++k) {
    from.parts[k].bind(AREA_LOBE_WAYS_UNIT + k);
    to.parts[k].bind_image(AREA_LOBE_WAYS_IMAGE + k, GL_WRITE_ONLY);
  }
  blur_.set("axis", axis);
  blur_.use();
  gl::dispatch({size_.x, size_.y, 1}, {SQUARE_GROUP, SQUARE_GROUP, 1});
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
}

void AreaLobes::shade(const AreaLights& lights, const AreaGather& gather) const {
  set_receiver(shade_, lights);
  shade_.set("per_group", AreaGather::lights_in_group(lights.count()));
  gather.masks().bind(AREA_MASK_UNIT);
  kinds_.bind(AREA_LOBE_KIND_UNIT);
  for (GLuint k = 0; k < 3; ++k) ways_.parts[k].bind(AREA_LOBE_WAYS_UNIT + k);
  pictures_.bind(AREA_PANELS_UNIT);
  radiance_.bind_image(AREA_RADIANCE_IMAGE, GL_WRITE_ONLY);
  shade_.use();
  gl::dispatch({size_.x, size_.y, 1}, {SQUARE_GROUP, SQUARE_GROUP, 1});
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
}

double AreaLobes::narrow_share() const {
  const std::vector<float> kinds = kinds_.download(1);
  constexpr float NARROW = 2.0f;
  return double(std::count(kinds.begin(), kinds.end(), NARROW)) / double(kinds.size());
}

size_t AreaLobes::bytes() const {
  constexpr size_t OF_PICTURES = size_t(PANELS_MOST) * LAYER_TEXELS * LAYER_TEXELS * 16 * 4 / 3;
  return (7 * 16 + 1) * size_t(size_.x) * size_t(size_.y) + OF_PICTURES + panels_.bytes();
}

}  // namespace volgi::screen
