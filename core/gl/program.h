#pragma once
#include <epoxy/gl.h>

#include <glm/glm.hpp>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "core/gl/objects.h"

namespace volgi::gl {

/// A linked program from files under shaders/ (embedded in the library at build time; core/gl/shader_source.h has the
/// exception). One that was made before in this context from the same text, and is no longer used, is taken again.
/// `#include "shared/x.shared.h"` is expanded with #line; `defines` become "#define A B" after #version.
/// @throws Error(no_device) with the compiler's message and the shader's name when the driver refuses it.
class Program {
 public:
  Program() = default;
  static Program compute(std::string_view file, const std::vector<std::string>& defines = {});
  /// BASE.vert.glsl + BASE.frag.glsl (+ BASE.geom.glsl where it exists).
  static Program raster(std::string_view base, const std::vector<std::string>& defines = {});
  static Program raster(std::string_view vertex_file, std::string_view fragment_file,
                        const std::vector<std::string>& defines = {});
  /// BASE.vert.glsl + BASE.geom.glsl, whose outputs of that name a transform feedback keeps; nothing is drawn.
  static Program feedback(std::string_view base, const char* kept, const std::vector<std::string>& defines = {});
  ~Program();
  Program(Program&&) noexcept;
  Program& operator=(Program&&) noexcept;
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  void use() const;
  GLuint id() const { return id_; }
  // Uniforms by name, on this program (no need to be in use). A name that the linker removed is ignored.
  void set(const char* name, int v) const;
  void set(const char* name, GLuint v) const;
  void set(const char* name, float v) const;
  void set(const char* name, glm::vec2 v) const;
  void set(const char* name, glm::vec3 v) const;
  void set(const char* name, glm::vec4 v) const;
  void set(const char* name, glm::ivec2 v) const;
  void set(const char* name, glm::ivec3 v) const;
  void set(const char* name, const glm::mat3& v) const;
  void set(const char* name, const glm::mat4& v) const;

 private:
  struct Stage;
  static Program link(const std::vector<Stage>& stages, const std::vector<std::string>& defines,
                      const char* kept = nullptr);
  GLint location(const char* name) const;
  GLuint id_ = 0;
  std::string pool_key_;
  mutable std::unordered_map<std::string, GLint> locations_;
};

/// Dispatches enough groups of `local` to cover `size`.
/// @throws Error(over_limit) when that is more groups along an axis than this GPU takes; GL promises 65535.
void dispatch(glm::ivec3 size, glm::ivec3 local);

/// Dispatches at least `count` invocations in groups of `group_size`, in further rows where there are more groups than
/// GL promises along x. Shaders number them by global_index() of shared/global_index.shared.h, never by
/// gl_GlobalInvocationID.x. @throws Error(over_limit) when an int cannot count them.
void dispatch_linear(size_t count, size_t group_size);

/// Dispatches as many groups as the three first words of `groups` say, which shaders have written.
void dispatch_indirect(const Buffer& groups);

/// The text of an embedded shader file, includes expanded (for tests and tools).
std::string shader_source(std::string_view file);

}  // namespace volgi::gl
