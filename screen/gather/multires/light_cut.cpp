#include "screen/gather/multires/light_cut.h"

#include "shaders/screen/base/slots.shared.h"
#include "shaders/screen/gather/multires/slots.shared.h"
#include "shaders/screen/visibility/area_maps/slots.shared.h"

namespace volgi::screen {

namespace {

gl::Texture picture(glm::ivec2 size) { return gl::Texture::make_2d(GL_RGBA32F, size.x, size.y); }

}  // namespace

LightCut::LightCut(glm::ivec2 size, const AreaLightShadow& shadow)
    : shadow_define_(shadow.define()), direct_(picture(size)), indirect_(picture(size)) {}

void LightCut::look_at(const LightTree& tree, const LightClusters& clusters, bool with_direct) {
  tree_ = &tree;
  clusters_ = &clusters;
  with_direct_ = with_direct;
}

const gl::Program& LightCut::program() {
  std::optional<gl::Program>& program = programs_[with_direct_ ? 1 : 0];
  if (!program) {
    std::vector<std::string> defines{shadow_define_};
    if (with_direct_) defines.emplace_back("WITH_DIRECT");
    program = gl::Program::compute("screen/gather/multires/light_cut.comp.glsl", defines);
  }
  return *program;
}

void LightCut::gather(const WorkList& list, int /*step_px*/, std::span<const gl::Texture> irradiance,
                      gl::PassTimer& timer) {
  const auto scope = timer.scope(name);
  const gl::Program& cut = program();
  list.bind(PIXEL_LIST_SLOT);
  tree_->bind(cut);
  clusters_->area_lights.buffer().bind_uniform(AREA_LIGHTS_BLOCK);
  clusters_->shadow.bind(clusters_->maps, cut);
  irradiance[0].bind_image(CUT_INDIRECT_IMAGE, GL_WRITE_ONLY);
  if (with_direct_) irradiance[1].bind_image(CUT_DIRECT_IMAGE, GL_WRITE_ONLY);
  cut.use();
  list.dispatch();
}

std::vector<const gl::Texture*> LightCut::radiance() const {
  std::vector<const gl::Texture*> pictures{&indirect_};
  if (with_direct_) pictures.push_back(&direct_);
  return pictures;
}

size_t LightCut::bytes() const { return 2 * 16 * size_t(direct_.size().x) * size_t(direct_.size().y); }

}  // namespace volgi::screen
