#pragma once
#include <epoxy/gl.h>

#include <functional>
#include <optional>
#include <span>
#include <string>

namespace volgi::gl {

/// What the passes need of the driver, and who needs most.
struct Limit {
  GLenum name;
  const char* text;  // the name as GL spells it
  GLint64 need;
  const char* user;  // a pass that needs as much
};
/// All that GL 4.5 does not promise, or that a shader to come could exceed.
std::span<const Limit> needed_limits();

/// The first limit that falls short, as one line that names the limit, the need, the pass and what there is; empty when
/// none does. @param have  what the driver has, by the limit's name.
std::string first_shortage(std::span<const Limit> needed, const std::function<GLint64(GLenum)>& have);

/// A limit of the current context, asked of the driver once. @param index  of one that has several values, such as
/// GL_MAX_COMPUTE_WORK_GROUP_COUNT of an axis.
GLint64 limit(GLenum name, std::optional<GLuint> index = std::nullopt);

/// `wanted` where this GPU can render to 2D textures of that format, else `otherwise`.
GLenum renderable_format(GLenum wanted, GLenum otherwise);

}  // namespace volgi::gl
