#pragma once
#include <glm/glm.hpp>
#include <span>

#include "core/gl/objects.h"
#include "core/gl/program.h"
#include "core/gl/scene_buffers.h"

namespace volgi::screen {

/// Colours light that has passed panes of AlphaMode::glass: draws them once more over a map of what is nearest and
/// multiplies colours by the tint of every pane in front of it. Where panes are let through by chance
/// (material_keeps), it is those. Cost: one draw of the panes.
class Glass {
 public:
  Glass();
  /// @param target  one or two pictures: colours are multiplied, alpha keeps what is nearer of itself and a pane's
  /// depth
  ///   (0: none). Its depth is that of a pass drawn with `clip_from_world` and MATERIAL_TINTED.
  void run(const gl::SceneBuffers& scene, const gl::Framebuffer& target, const glm::mat4& clip_from_world) const;

 private:
  gl::Program program_;
};

}  // namespace volgi::screen
