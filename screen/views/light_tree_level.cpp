#include "screen/views/light_tree_level.h"

#include <algorithm>

#include "shaders/screen/views/slots.shared.h"
#include "shaders/shared/group_sizes.shared.h"
#include "shaders/shared/virtual_light.shared.h"

namespace volgi::screen {

LightTreeLevel::LightTreeLevel() : program_(gl::Program::compute("screen/views/light_tree_level.comp.glsl")) {}

const VirtualLightListGl& LightTreeLevel::run(const LightTree& tree, int level, gl::PassTimer& timer) {
  const auto scope = timer.scope(name);
  const int shown = std::clamp(level, 0, tree.top_level());
  lights_.reflected = tree.most_roots() << (2 * (tree.top_level() - shown));
  lights_.of_light = {lights_.reflected};
  gl::reserve(lights_.buffer, padded_count(lights_) * sizeof(shared::VirtualLight));
  tree.nodes().bind_storage(VIEWED_NODES_SLOT);
  lights_.buffer.bind_storage(LIGHTS_OF_NODES_SLOT);
  program_.set("top_level", tree.top_level());
  program_.set("most_roots", tree.most_roots());
  program_.set("level", shown);
  program_.set("count", lights_.reflected);
  program_.use();
  gl::dispatch_linear(size_t(lights_.reflected), LINEAR_GROUP);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT);
  return lights_;
}

}  // namespace volgi::screen
