#include "core/gl/limits.h"

#include <array>

namespace volgi::gl {

// tests/core/gl/limits_test.cpp holds the bindings, blocks and sizes that the shaders declare to these.
std::span<const Limit> needed_limits() {
#define VOLGI_LIMIT(name, need, user) \
  Limit { name, #name, need, user }
  static constexpr std::array limits{
      VOLGI_LIMIT(GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS, 15, "propagation/solver_source"),
      VOLGI_LIMIT(GL_MAX_COMPUTE_SHADER_STORAGE_BLOCKS, 11, "propagation/solver_source"),
      VOLGI_LIMIT(GL_MAX_FRAGMENT_SHADER_STORAGE_BLOCKS, 6, "voxel/cell_volumes"),
      VOLGI_LIMIT(GL_MAX_UNIFORM_BLOCK_SIZE, 65536, "screen/gather/interleaved/area_light_gather"),
      VOLGI_LIMIT(GL_MAX_COMPUTE_UNIFORM_BLOCKS, 2, "screen/gather/interleaved/area_light_gather"),
      VOLGI_LIMIT(GL_MAX_COMPUTE_IMAGE_UNIFORMS, 5, "screen/base/smooth_pixels"),
      VOLGI_LIMIT(GL_MAX_IMAGE_UNITS, 5, "screen/base/smooth_pixels"),
      VOLGI_LIMIT(GL_MAX_COMPUTE_TEXTURE_IMAGE_UNITS, 16, "screen/bounces/glossy/side_punctual"),
      VOLGI_LIMIT(GL_MAX_TEXTURE_IMAGE_UNITS, 16, "screen/base/compose"),
      VOLGI_LIMIT(GL_MAX_TEXTURE_BUFFER_SIZE, 1 << 22, "screen/gather/multires/light_cut"),
      VOLGI_LIMIT(GL_MAX_COMPUTE_SHARED_MEMORY_SIZE, 32768, "propagation/sweep"),
      VOLGI_LIMIT(GL_MAX_COMPUTE_WORK_GROUP_INVOCATIONS, 1024, "propagation/sweep"),
      VOLGI_LIMIT(GL_MAX_COLOR_ATTACHMENTS, 5, "screen/base/gbuffer"),
      VOLGI_LIMIT(GL_MAX_DRAW_BUFFERS, 5, "screen/base/gbuffer"),
  };
#undef VOLGI_LIMIT
  return limits;
}

std::string first_shortage(std::span<const Limit> needed, const std::function<GLint64(GLenum)>& have) {
  for (const Limit& limit : needed) {
    const GLint64 there = have(limit.name);
    if (there < limit.need) {
      return std::string(limit.text) + " is " + std::to_string(there) + ", and " + limit.user + " needs " +
             std::to_string(limit.need);
    }
  }
  return {};
}

GLenum renderable_format(GLenum wanted, GLenum otherwise) {
  GLint support = GL_NONE;
  glGetInternalformativ(GL_TEXTURE_2D, wanted, GL_FRAMEBUFFER_RENDERABLE, 1, &support);
  return support == GL_FULL_SUPPORT ? wanted : otherwise;
}

}  // namespace volgi::gl
