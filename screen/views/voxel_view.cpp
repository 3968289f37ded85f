#include "screen/views/voxel_view.h"

#include <array>
#include <cmath>

#include "core/gl/raster_state.h"
#include "screen/views/view_camera_internal.h"

namespace volgi::screen {
namespace {

using shared::Side;

// Vertex buffers.
constexpr GLuint SIDES = 0, DIRECT = 1, INDIRECT = 2;

constexpr std::array<GLuint, 4> SQUARES{4, 0, 0, 0};  // vertices, instances, first vertex, first instance
constexpr GLintptr INSTANCES_AT = sizeof(GLuint);

void read_irradiance(const Instances& sides, GLuint binding, const gl::Buffer* irradiance, const gl::Buffer& black) {
  sides.read(binding, irradiance != nullptr ? *irradiance : black, irradiance != nullptr ? sizeof(glm::vec4) : 0);
}

}  // namespace

VoxelView::VoxelView()
    : program_(gl::Program::raster(name)), command_(sizeof SQUARES, SQUARES.data()), black_(sizeof(glm::vec4)) {
  black_.clear();
  // As voxel_view.vert.glsl reads them.
  sides_.add_floats(0, 4, SIDES, offsetof(Side, normal));
  sides_.add_floats(1, 3, SIDES, offsetof(Side, albedo));
  sides_.add_floats(2, 3, SIDES, offsetof(Side, radiosity));
  sides_.add_integers(3, 2, SIDES, offsetof(Side, cell));
  sides_.add_floats(4, 3, DIRECT, 0);
  sides_.add_floats(5, 3, INDIRECT, 0);
}

void VoxelView::run(const VoxelGridGl& voxels, const gl::Buffer* direct, const gl::Buffer* indirect,
                    const Camera& camera, const Options& options, const gl::Framebuffer& target, gl::PassTimer& timer) {
  const auto scope = timer.scope(name);
  gl::begin_geometry_pass();
  target.bind();
  // Sides, their number and their light may come from shaders.
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT | GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT);
  glCopyNamedBufferSubData(voxels.side_count.id(), command_.id(), 0, INSTANCES_AT, sizeof(GLuint));
  sides_.read(SIDES, voxels.sides, sizeof(Side));
  read_irradiance(sides_, DIRECT, direct, black_);
  read_irradiance(sides_, INDIRECT, indirect, black_);
  voxels.bind();
  set_view_camera(program_, camera, target.size());
  program_.set("mode", int(options.mode));
  program_.set("exposure", std::exp2(options.exposure_ev));
  program_.use();
  glBindVertexArray(sides_.id());
  glBindBuffer(GL_DRAW_INDIRECT_BUFFER, command_.id());
  glDrawArraysIndirect(GL_TRIANGLE_STRIP, nullptr);
  glBindVertexArray(0);
}

}  // namespace volgi::screen
