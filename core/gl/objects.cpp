#include "core/gl/objects.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cassert>
#include <cstddef>
#include <cstring>
#include <string>

#include "core/error.h"
#include "core/gl/context.h"
#include "core/gl/limits.h"
#include "core/gl/storage.h"

namespace volgi::gl {

void delete_buffer(GLuint id) { glDeleteBuffers(1, &id); }
void delete_texture(GLuint id) { glDeleteTextures(1, &id); }
void delete_framebuffer(GLuint id) { glDeleteFramebuffers(1, &id); }
void delete_vertex_array(GLuint id) { glDeleteVertexArrays(1, &id); }

namespace {
std::atomic<std::uint64_t> made = 0;
}

std::uint64_t objects_made() { return made; }
void count_object(std::uint64_t objects) { made += objects; }

namespace {

void throw_if_out_of_memory(const std::string& what) {
  if (out_of_memory()) {
    throw Error(ExitCode::over_limit, "the GPU has no memory for " + what + "; use a smaller grid or picture");
  }
}

std::string size_text(glm::ivec3 size) {
  return std::to_string(size.x) + " x " + std::to_string(size.y) + " x " + std::to_string(size.z);
}

void check_texture_size(glm::ivec3 size, GLenum width_limit, GLenum depth_limit) {
  assert(size.x > 0 && size.y > 0 && size.z > 0);
  const GLint64 side = limit(width_limit);
  const GLint64 depth = depth_limit == GL_NONE ? 1 : limit(depth_limit);
  if (size.x > side || size.y > side || size.z > depth) {
    throw Error(ExitCode::over_limit, "a texture of " + size_text(size) + " texels exceeds this GPU's " +
                                          std::to_string(side) + " x " + std::to_string(side) + " x " +
                                          std::to_string(depth) + "; use a smaller grid or picture");
  }
}

enum class FormatClass { colour, depth, unsigned_integer, signed_integer };

FormatClass format_class(GLenum format) {
  switch (format) {
    case GL_DEPTH_COMPONENT16:
    case GL_DEPTH_COMPONENT24:
    case GL_DEPTH_COMPONENT32F:
      return FormatClass::depth;
    case GL_R8UI:
    case GL_R16UI:
    case GL_R32UI:
    case GL_RG16UI:
    case GL_RG32UI:
    case GL_RGBA8UI:
    case GL_RGBA16UI:
    case GL_RGBA32UI:
      return FormatClass::unsigned_integer;
    case GL_R32I:
    case GL_RG32I:
    case GL_RGBA32I:
      return FormatClass::signed_integer;
    default:
      return FormatClass::colour;
  }
}

template <class T>
std::vector<float> read_texture(GLuint id, GLenum format, GLenum type, size_t count) {
  std::vector<T> values(count);
  glGetTextureImage(id, 0, format, type, GLsizei(count * sizeof(T)), values.data());
  throw_on_error();
  return {values.begin(), values.end()};
}

}  // namespace

Buffer::Buffer(size_t bytes, const void* data, GLbitfield flags) : bytes_(std::max<size_t>(bytes, 16)) {
  const auto max_bytes = static_cast<size_t>(limit(GL_MAX_SHADER_STORAGE_BLOCK_SIZE));
  if (bytes_ > max_bytes) {
    throw Error(ExitCode::over_limit, "a GPU buffer of " + std::to_string(bytes_) + " bytes exceeds this GPU's " +
                                          std::to_string(max_bytes) +
                                          " bytes; use a smaller grid or picture, or fewer lights or triangles");
  }
  GLuint id = 0;
  glCreateBuffers(1, &id);
  count_object();
  handle_ = Handle<delete_buffer>(id);
  std::array<std::byte, 16> padded{};  // what is smaller than the smallest buffer is not read beyond its end
  if (data != nullptr && bytes < padded.size()) {
    std::memcpy(padded.data(), data, bytes);
    data = padded.data();
  }
  glNamedBufferStorage(id, GLsizeiptr(bytes_), data, flags);
  throw_if_out_of_memory("a buffer of " + std::to_string(bytes_) + " bytes");
}

void Buffer::bind_storage(GLuint binding) const { glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, id()); }
void Buffer::bind_uniform(GLuint binding) const { glBindBufferBase(GL_UNIFORM_BUFFER, binding, id()); }

void reserve(Buffer& buffer, size_t bytes) {
  if (buffer.id() == 0 || buffer.bytes() < bytes) buffer = Buffer(bytes);
}

// GL orders its own writes after those of shaders only behind this barrier; shaders see them without one.
void Buffer::clear() const {
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glClearNamedBufferData(id(), GL_R8UI, GL_RED_INTEGER, GL_UNSIGNED_BYTE, nullptr);
}

void Buffer::fill(GLuint word) const { fill(word, bytes_ / sizeof word, 0); }

void Buffer::fill(GLuint word, size_t count, size_t first) const {
  assert((first + count) * sizeof word <= bytes_);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glClearNamedBufferSubData(id(), GL_R32UI, GLintptr(first * sizeof word), GLsizeiptr(count * sizeof word),
                            GL_RED_INTEGER, GL_UNSIGNED_INT, &word);
}

void Buffer::upload(const void* data, size_t bytes, size_t offset) const {
  assert(offset + bytes <= bytes_);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  if (bytes > 0) glNamedBufferSubData(id(), GLintptr(offset), GLsizeiptr(bytes), data);
}

void Buffer::download(void* data, size_t bytes, size_t offset) const {
  assert(offset + bytes <= bytes_);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  if (bytes > 0) glGetNamedBufferSubData(id(), GLintptr(offset), GLsizeiptr(bytes), data);
  throw_on_error();
}

Texture Texture::make_2d(GLenum format, int width, int height, int levels) {
  check_texture_size({width, height, 1}, GL_MAX_TEXTURE_SIZE, GL_NONE);
  format = stored_format(format);
  Texture t(GL_TEXTURE_2D, format, {width, height, 1});
  glTextureStorage2D(t.id(), levels, format, width, height);
  t.finish();
  return t;
}

Texture Texture::make_2d_array(GLenum format, int width, int height, int layers, int levels) {
  check_texture_size({width, height, layers}, GL_MAX_TEXTURE_SIZE, GL_MAX_ARRAY_TEXTURE_LAYERS);
  format = stored_format(format);
  Texture t(GL_TEXTURE_2D_ARRAY, format, {width, height, layers});
  glTextureStorage3D(t.id(), levels, format, width, height, layers);
  t.finish();
  return t;
}

Texture Texture::make_3d(GLenum format, glm::ivec3 size) {
  check_texture_size(size, GL_MAX_3D_TEXTURE_SIZE, GL_MAX_3D_TEXTURE_SIZE);
  format = stored_format(format);
  Texture t(GL_TEXTURE_3D, format, size);
  glTextureStorage3D(t.id(), 1, format, size.x, size.y, size.z);
  t.finish();
  return t;
}

Texture Texture::view_of(const Buffer& buffer, GLenum format, int bytes_per_texel) {
  const int texels = int(buffer.bytes() / size_t(bytes_per_texel));
  check_texture_size({texels, 1, 1}, GL_MAX_TEXTURE_BUFFER_SIZE, GL_NONE);
  Texture t(GL_TEXTURE_BUFFER, format, {texels, 1, 1});
  glTextureBuffer(t.id(), format, buffer.id());
  return t;
}

Texture::Texture(GLenum target, GLenum format, glm::ivec3 size) : target_(target), format_(format), size_(size) {
  GLuint id = 0;
  glCreateTextures(target, 1, &id);
  count_object();
  handle_ = Handle<delete_texture>(id);
}

void Texture::finish() const {
  throw_if_out_of_memory("a texture of " + size_text(size_) + " texels");
  filter(GL_NEAREST, GL_NEAREST);
  wrap(GL_CLAMP_TO_EDGE);
}

void Texture::bind(GLuint unit) const { glBindTextureUnit(unit, id()); }

void Texture::bind_image(GLuint unit, GLenum access) const {
  glBindImageTexture(unit, id(), 0, GL_TRUE, 0, access, format_);
}

void Texture::filter(GLenum min_filter, GLenum mag_filter) const {
  glTextureParameteri(id(), GL_TEXTURE_MIN_FILTER, GLint(min_filter));
  glTextureParameteri(id(), GL_TEXTURE_MAG_FILTER, GLint(mag_filter));
}

void Texture::wrap(GLenum mode) const { wrap(mode, mode); }

void Texture::wrap(GLenum s, GLenum t) const {
  glTextureParameteri(id(), GL_TEXTURE_WRAP_S, GLint(s));
  glTextureParameteri(id(), GL_TEXTURE_WRAP_T, GLint(t));
  glTextureParameteri(id(), GL_TEXTURE_WRAP_R, GLint(s));
}

void Texture::clear(const float (&rgba)[4]) const {
  const FormatClass kind = format_class(format_);
  assert(kind != FormatClass::depth);
  glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);
  if (kind == FormatClass::colour) {
    glClearTexImage(id(), 0, GL_RGBA, GL_FLOAT, rgba);
  } else {
    const std::array<GLint, 4> v{GLint(rgba[0]), GLint(rgba[1]), GLint(rgba[2]), GLint(rgba[3])};
    glClearTexImage(id(), 0, GL_RGBA_INTEGER, kind == FormatClass::signed_integer ? GL_INT : GL_UNSIGNED_INT, v.data());
  }
}

std::vector<float> Texture::download(int channels) const {
  assert(channels >= 1 && channels <= 4);
  constexpr std::array<GLenum, 4> colour{GL_RED, GL_RG, GL_RGB, GL_RGBA};
  constexpr std::array<GLenum, 4> integer{GL_RED_INTEGER, GL_RG_INTEGER, GL_RGB_INTEGER, GL_RGBA_INTEGER};
  const auto c = static_cast<size_t>(channels);
  const size_t count = size_t(size_.x) * size_t(size_.y) * size_t(size_.z) * c;
  glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);
  switch (format_class(format_)) {
    case FormatClass::depth:
      assert(channels == 1);
      return read_texture<float>(id(), GL_DEPTH_COMPONENT, GL_FLOAT, count);
    case FormatClass::unsigned_integer:
      return read_texture<GLuint>(id(), integer[c - 1], GL_UNSIGNED_INT, count);
    case FormatClass::signed_integer:
      return read_texture<GLint>(id(), integer[c - 1], GL_INT, count);
    case FormatClass::colour:
      break;
  }
  return read_texture<float>(id(), colour[c - 1], GL_FLOAT, count);
}

Framebuffer::Framebuffer(std::span<const Attachment> colors, Attachment depth, glm::ivec2 size) : size_(size) {
  GLuint id = 0;
  glCreateFramebuffers(1, &id);
  count_object();
  handle_ = Handle<delete_framebuffer>(id);
  const auto attach = [id](GLenum point, const Attachment& a) {
    if (a.layer < 0) {
      glNamedFramebufferTexture(id, point, a.texture->id(), 0);
    } else {
      glNamedFramebufferTextureLayer(id, point, a.texture->id(), 0, a.layer);
    }
  };
  std::vector<GLenum> points;
  for (const Attachment& color : colors) {
    points.push_back(GLenum(GL_COLOR_ATTACHMENT0 + points.size()));
    attach(points.back(), color);
  }
  glNamedFramebufferDrawBuffers(id, GLsizei(points.size()), points.data());
  if (depth.texture != nullptr) {
    const bool with_stencil = depth.texture->format() == GL_DEPTH24_STENCIL8;
    attach(with_stencil ? GL_DEPTH_STENCIL_ATTACHMENT : GL_DEPTH_ATTACHMENT, depth);
  }
  const GLenum status = glCheckNamedFramebufferStatus(id, GL_DRAW_FRAMEBUFFER);
  if (status != GL_FRAMEBUFFER_COMPLETE) {
    throw Error(ExitCode::no_device, "this GPU cannot render to the textures of a pass (framebuffer status " +
                                         std::to_string(status) + "); use --backend cpu");
  }
}

Framebuffer Framebuffer::without_attachments(glm::ivec2 size) {
  Framebuffer f;
  GLuint id = 0;
  glCreateFramebuffers(1, &id);
  count_object();
  f.handle_ = Handle<delete_framebuffer>(id);
  f.size_ = size;
  glNamedFramebufferParameteri(id, GL_FRAMEBUFFER_DEFAULT_WIDTH, size.x);
  glNamedFramebufferParameteri(id, GL_FRAMEBUFFER_DEFAULT_HEIGHT, size.y);
  return f;
}

void Framebuffer::bind() const {
  glBindFramebuffer(GL_FRAMEBUFFER, id());
  glViewport(0, 0, size_.x, size_.y);
}

void draw_fullscreen_triangle() {
  glBindVertexArray(empty_vertex_array());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glBindVertexArray(0);
}

}  // namespace volgi::gl
