#pragma once
#include "core/gl/pass_timer.h"
#include "core/gl/program.h"
#include "screen/base/virtual_light_list_gl.h"
#include "screen/gather/multires/light_tree.h"

namespace volgi::screen {

/// Pass "screen/views/light_tree_level": the nodes of one level of a light tree as virtual lights, for LightsView;
/// `source` is their cluster. Dark nodes have no flux.
class LightTreeLevel {
 public:
  static constexpr const char* name = "screen/views/light_tree_level";
  LightTreeLevel();
  /// @param level  0: the leaves; above the topmost: the roots.
  const VirtualLightListGl& run(const LightTree& tree, int level, gl::PassTimer& timer);

 private:
  VirtualLightListGl lights_;
  gl::Program program_;
};

}  // namespace volgi::screen
