#include "screen/views/lights_view.h"

#include "core/gl/context.h"
#include "core/gl/raster_state.h"
#include "screen/views/view_camera_internal.h"
#include "shaders/screen/base/slots.shared.h"
#include "shaders/screen/views/slots.shared.h"
#include "shaders/screen/visibility/area_maps/slots.shared.h"

namespace volgi::screen {
namespace {

using shared::NegativeLight, shared::VirtualLight;

// Negative lights are drawn, and summed, as virtual ones.
static_assert(sizeof(NegativeLight) == sizeof(VirtualLight) &&
              offsetof(NegativeLight, position) == offsetof(VirtualLight, position) &&
              offsetof(NegativeLight, direction) == offsetof(VirtualLight, normal) &&
              offsetof(NegativeLight, flux) == offsetof(VirtualLight, flux));

// Vertex buffers.
constexpr GLuint LIGHTS = 0, CLUSTERS = 1;

constexpr GLsizei SQUARE_LINE_ENDS = 10;  // four edges and a normal

}  // namespace

LightsView::LightsView()
    : total_(gl::Program::compute("screen/views/lights_view_total.comp.glsl")),
      disks_(gl::Program::raster(name)),
      ticks_(gl::Program::raster("screen/views/lights_view.vert.glsl", "screen/views/lines.frag.glsl", {"TICKS"})),
      squares_(gl::Program::raster("screen/views/lights_view_areas.vert.glsl", "screen/views/lines.frag.glsl")),
      total_flux_(sizeof(glm::vec4)) {
  // As lights_view.vert.glsl reads them.
  lights_.add_floats(0, 3, LIGHTS, offsetof(VirtualLight, position));
  lights_.add_floats(1, 3, LIGHTS, offsetof(VirtualLight, normal));
  lights_.add_floats(2, 3, LIGHTS, offsetof(VirtualLight, flux));
  lights_.add_integers(3, 1, LIGHTS, offsetof(VirtualLight, source));
  lights_.add_integers(4, 1, CLUSTERS, 0);
}

void LightsView::sum_flux(const gl::Buffer& lights, int count) {
  lights.bind_storage(VIRTUAL_LIGHTS_SLOT);
  total_flux_.bind_storage(TOTAL_FLUX_SLOT);
  total_.set("count", count);
  total_.use();
  glDispatchCompute(1, 1, 1);
  glMemoryBarrier(GL_UNIFORM_BARRIER_BIT);
}

void LightsView::draw_lights(const gl::Buffer& lights, int count, const gl::Buffer* cluster_of, bool negative,
                             const Options& options) {
  lights_.read(LIGHTS, lights, sizeof(VirtualLight));
  lights_.read(CLUSTERS, cluster_of != nullptr ? *cluster_of : lights, cluster_of != nullptr ? sizeof(GLuint) : 0);
  total_flux_.bind_uniform(TOTAL_FLUX_BLOCK);
  const bool clusters = options.mode == Mode::cluster && cluster_of != nullptr;
  const Mode mode = options.mode == Mode::cluster && !clusters ? Mode::flux : options.mode;
  glBindVertexArray(lights_.id());
  for (const gl::Program* program : {&disks_, &ticks_}) {
    program->set("mode", int(mode));
    program->set("negative", int(negative));
    program->set("share", options.share);
    program->set("least_radius_px", options.least_radius_px);
    program->set("tick_px", options.tick_px);
  }
  disks_.use();
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, count);
  if (options.tick_px > 0.0f) {
    ticks_.use();
    glDrawArraysInstanced(GL_LINES, 0, 2, count);
  }
  glBindVertexArray(0);
}

void LightsView::run(const Shown& shown, const Camera& camera, const Options& options, const gl::Framebuffer& target,
                     gl::PassTimer& timer) {
  const auto scope = timer.scope(name);
  gl::begin_geometry_pass();
  target.bind();
  // Lights come from shaders.
  glMemoryBarrier(GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT | GL_UNIFORM_BARRIER_BIT);
  for (const gl::Program* program : {&disks_, &ticks_, &squares_}) set_view_camera(*program, camera, target.size());
  const int count = shown.lights != nullptr ? shown.lights->count() : 0;
  const int negative_count = shown.negative != nullptr ? shown.negative->count() : 0;
  if (count > 0) {
    sum_flux(shown.lights->buffer, count);
    const gl::Buffer* cluster_of = shown.area_lights != nullptr ? &shown.area_lights->cluster_of() : nullptr;
    draw_lights(shown.lights->buffer, count, cluster_of, false, options);
  }
  if (negative_count > 0) {
    if (count == 0) sum_flux(shown.negative->buffer(), negative_count);
    draw_lights(shown.negative->buffer(), negative_count, nullptr, true, options);
  }
  if (shown.area_lights == nullptr || !options.squares) return;
  shown.area_lights->buffer().bind_uniform(AREA_LIGHTS_BLOCK);
  squares_.use();
  glBindVertexArray(gl::empty_vertex_array());
  glDrawArraysInstanced(GL_LINES, 0, SQUARE_LINE_ENDS, shown.area_lights->count());
  glBindVertexArray(0);
}

}  // namespace volgi::screen
