#include "screen/views/lobe_view.h"

#include <cmath>

#include "core/gl/context.h"
#include "core/gl/raster_state.h"
#include "screen/views/view_camera_internal.h"
#include "shaders/screen/views/slots.shared.h"

namespace volgi::screen {
namespace {

constexpr GLsizei CUBE_LINE_ENDS = 24;
constexpr GLsizei LOBE_CORNERS = 6 * LOBE_RINGS * LOBE_SEGMENTS;

}  // namespace

LobeView::LobeView()
    : lobe_(gl::Program::raster(name)),
      cube_(gl::Program::raster("screen/views/lobe_view.vert.glsl", "screen/views/lines.frag.glsl", {"CUBE"})) {}

void LobeView::run(const RadianceVolumeGl& radiance, const Camera& camera, const Options& options,
                   const gl::Framebuffer& target, gl::PassTimer& timer) {
  const auto scope = timer.scope(name);
  gl::begin_geometry_pass();
  target.bind();
  const Grid& grid = radiance.grid;
  const glm::ivec3 cell = glm::clamp(options.cell, glm::ivec3(0), grid.cells - 1);
  for (const gl::Program* program : {&lobe_, &cube_}) {
    set_view_camera(*program, camera, target.size());
    program->set("cell", cell);
    program->set("centre", shared::world_from_cell(grid, glm::vec3(cell) + 0.5f));
    program->set("cell_size_m", grid.cell_size_m);
  }
  radiance.sh.bind(VIEWED_RADIANCE_UNIT);
  lobe_.set("coefficients", radiance.coefficients);
  lobe_.set("layers", grid.cells.z);
  lobe_.set("radius_m", options.radius_cells * grid.cell_size_m);
  lobe_.set("exposure", std::exp2(options.exposure_ev));
  glBindVertexArray(gl::empty_vertex_array());
  lobe_.use();
  glDrawArrays(GL_TRIANGLES, 0, LOBE_CORNERS);
  cube_.use();
  glDrawArrays(GL_LINES, 0, CUBE_LINE_ENDS);
  glBindVertexArray(0);
}

glm::ivec3 nearest_cell(const Grid& grid, glm::vec3 position) {
  const glm::vec3 cell = glm::floor(shared::cell_from_world(grid, position));
  return glm::ivec3(glm::clamp(cell, glm::vec3(0.0f), glm::vec3(grid.cells - 1)));
}

}  // namespace volgi::screen
