#include "core/gl/raster_state.h"

#include <epoxy/gl.h>

namespace volgi::gl {
namespace {

void begin_pass() {
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  glDisable(GL_CULL_FACE);
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_MULTISAMPLE);
  glDisable(GL_STENCIL_TEST);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

}  // namespace

void begin_geometry_pass() {
  begin_pass();
  glDisable(GL_BLEND);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_GREATER);
  glDepthMask(GL_TRUE);
}

void begin_filter_pass() {
  begin_geometry_pass();
  glDepthMask(GL_FALSE);
  glEnable(GL_BLEND);
  glBlendEquationSeparate(GL_FUNC_ADD, GL_MAX);
  glBlendFuncSeparate(GL_ZERO, GL_SRC_COLOR, GL_ONE, GL_ONE);
}

void begin_fullscreen_pass(bool add) {
  begin_pass();
  glDisable(GL_DEPTH_TEST);
  if (add) {
    glEnable(GL_BLEND);
    glBlendEquation(GL_FUNC_ADD);
    glBlendFunc(GL_ONE, GL_ONE);
  } else {
    glDisable(GL_BLEND);
  }
}

}  // namespace volgi::gl
