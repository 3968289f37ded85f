#pragma once
#include <epoxy/gl.h>

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace volgi::gl {

/// Move-only owner of a GL name.
template <void (*Delete)(GLuint)>
class Handle {
 public:
  Handle() = default;
  explicit Handle(GLuint id) : id_(id) {}
  ~Handle() { reset(); }
  Handle(Handle&& o) noexcept : id_(o.id_) { o.id_ = 0; }
  Handle& operator=(Handle&& o) noexcept {
    if (this != &o) {
      reset();
      id_ = o.id_;
      o.id_ = 0;
    }
    return *this;
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  GLuint id() const { return id_; }
  explicit operator bool() const { return id_ != 0; }
  /// To an owner that ends it otherwise.
  GLuint release() {
    const GLuint id = id_;
    id_ = 0;
    return id;
  }

 private:
  void reset() {
    if (id_ != 0) Delete(id_);
    id_ = 0;
  }
  GLuint id_ = 0;
};

void delete_buffer(GLuint id);
void delete_texture(GLuint id);
void delete_framebuffer(GLuint id);
void delete_vertex_array(GLuint id);

/// Buffers, textures, framebuffers, vertex arrays, programs and timer queries made so far, by all contexts: a steady
/// frame makes none. (Fences, one for each result on its way to the host, do not count.)
std::uint64_t objects_made();
/// For what makes GL objects outside this file.
void count_object(std::uint64_t objects = 1);

/// Immutable buffer storage (direct state access). Size 0 becomes 16 bytes, so that it can always be bound.
/// @throws Error(over_limit) naming both sizes when `bytes` exceeds GL_MAX_SHADER_STORAGE_BLOCK_SIZE or GL is out of
/// memory.
class Buffer {
 public:
  Buffer() = default;
  explicit Buffer(size_t bytes, const void* data = nullptr, GLbitfield flags = GL_DYNAMIC_STORAGE_BIT);
  template <class T>
  explicit Buffer(std::span<const T> data) : Buffer(data.size_bytes(), data.data()) {}
  template <class T>
  explicit Buffer(const std::vector<T>& data) : Buffer(std::span<const T>(data)) {}

  GLuint id() const { return handle_.id(); }
  size_t bytes() const { return bytes_; }
  void bind_storage(GLuint binding) const;
  void bind_uniform(GLuint binding) const;
  // Clears and uploads wait for what shaders have written there before.
  void clear() const;                                        // to zero bytes
  void fill(GLuint word) const;                              // all words
  void fill(GLuint word, size_t count, size_t first) const;  // words
  void upload(const void* data, size_t bytes, size_t offset = 0) const;
  /// Waits for the GPU: never in the middle of a frame. @throws Error(no_device) after an OpenGL error.
  void download(void* data, size_t bytes, size_t offset = 0) const;
  template <class T>
  std::vector<T> download(size_t count, size_t offset = 0) const {
    std::vector<T> v(count);
    download(v.data(), count * sizeof(T), offset);
    return v;
  }

 private:
  Handle<delete_buffer> handle_;
  size_t bytes_ = 0;
};

/// Makes room for `bytes`: replaces the buffer by a larger one where it is too small, which loses what was in it.
void reserve(Buffer& buffer, size_t bytes);
/// `data` at the beginning of the buffer: a new one only where that does not fit.
template <class T>
void put(Buffer& buffer, const std::vector<T>& data) {
  reserve(buffer, data.size() * sizeof(T));
  buffer.upload(data.data(), data.size() * sizeof(T));
}

/// Immutable texture storage, nearest filtering and clamped to the edge until told otherwise.
/// @throws Error(over_limit) when the GPU's texture limits or memory do not allow the size.
class Texture {
 public:
  Texture() = default;
  static Texture make_2d(GLenum format, int width, int height, int levels = 1);
  static Texture make_2d_array(GLenum format, int width, int height, int layers, int levels = 1);
  static Texture make_3d(GLenum format, glm::ivec3 size);
  /// A buffer as texels, for samplerBuffer; it holds no memory of its own and must not outlive the buffer's.
  static Texture view_of(const Buffer& buffer, GLenum format, int bytes_per_texel);

  GLuint id() const { return handle_.id(); }
  GLenum format() const { return format_; }
  glm::ivec3 size() const { return size_; }
  void bind(GLuint unit) const;
  void bind_image(GLuint unit, GLenum access) const;  // level 0, all layers
  void filter(GLenum min_filter, GLenum mag_filter) const;
  void wrap(GLenum mode) const;
  void wrap(GLenum s, GLenum t) const;
  void clear(const float (&rgba)[4]) const;  // colour formats; waits for what shaders have written there before
  /// Level 0 as floats, `channels` of them a texel (GL_RED, GL_RG, GL_RGB or GL_RGBA by 1..4; integers exact up to
  /// 2^24). Waits for the GPU. @throws Error(no_device) after an OpenGL error.
  std::vector<float> download(int channels) const;

 private:
  Texture(GLenum target, GLenum format, glm::ivec3 size);
  void finish() const;
  Handle<delete_texture> handle_;
  GLenum target_ = 0;
  GLenum format_ = 0;
  glm::ivec3 size_{0};
};

/// Framebuffer over whole textures. layer < 0 attaches the whole texture (layered when it has layers). A depth texture
/// of GL_DEPTH24_STENCIL8 is its stencil, too.
class Framebuffer {
 public:
  Framebuffer() = default;
  struct Attachment {
    const Texture* texture = nullptr;
    int layer = -1;
  };
  Framebuffer(std::span<const Attachment> colors, Attachment depth, glm::ivec2 size);
  /// No attachments: raster writes only through buffers and images.
  static Framebuffer without_attachments(glm::ivec2 size);
  void bind() const;  // and sets the viewport to its size
  glm::ivec2 size() const { return size_; }
  GLuint id() const { return handle_.id(); }

 private:
  Handle<delete_framebuffer> handle_;
  glm::ivec2 size_{0};
};

using VertexArray = Handle<delete_vertex_array>;

/// One triangle over the whole viewport from gl_VertexID (shaders/shared/fullscreen.vert.glsl).
void draw_fullscreen_triangle();

}  // namespace volgi::gl
