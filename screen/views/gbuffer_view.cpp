#include "screen/views/gbuffer_view.h"

#include <cmath>

#include "core/gl/raster_state.h"
#include "shaders/screen/views/slots.shared.h"

namespace volgi::screen {

GBufferView::GBufferView()
    : program_(gl::Program::raster("shared/fullscreen.vert.glsl", "screen/views/gbuffer_view.frag.glsl")) {}

void GBufferView::run(const GBuffer& gbuffer, const Camera& camera, const Options& options,
                      const gl::Framebuffer& target, gl::PassTimer& timer) {
  const auto scope = timer.scope(name);
  gl::begin_fullscreen_pass();
  target.bind();
  gbuffer.bind();
  gbuffer.emission().bind(VIEWED_EMISSION_UNIT);
  gbuffer.object_id().bind(VIEWED_OBJECT_ID_UNIT);
  const glm::vec3 eye(camera.world_from_camera[3]);
  const glm::vec3 forward = -glm::normalize(glm::vec3(camera.world_from_camera[2]));
  program_.set("mode", int(options.mode));
  program_.set("depth_plane", glm::vec4(forward, glm::dot(forward, eye)));
  program_.set("depth_range_m", options.depth_range_m);
  program_.set("exposure", std::exp2(options.exposure_ev));
  program_.use();
  gl::draw_fullscreen_triangle();
}

}  // namespace volgi::screen
