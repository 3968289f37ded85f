#include "screen/views/texture_view.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/gl/context.h"
#include "core/gl/raster_state.h"
#include "shaders/screen/views/slots.shared.h"

namespace volgi::screen {
namespace {

using Channel = TextureView::Channel;

GLint texture_parameter(const gl::Texture& texture, GLenum name) {
  GLint value = 0;
  glGetTextureParameteriv(texture.id(), name, &value);
  return value;
}

GLint level_parameter(const gl::Texture& texture, GLenum name) {
  GLint value = 0;
  glGetTextureLevelParameteriv(texture.id(), 0, name, &value);
  return value;
}

/// Where a texture lies in the picture.
struct Place {
  glm::vec2 first_pixel;
  glm::vec2 texels_per_pixel;
};
Place place(glm::vec2 texture_size, TextureView::Fit fit, glm::vec2 target_size) {
  glm::vec2 pixels_per_texel = target_size / texture_size;
  if (fit == TextureView::Fit::aspect) pixels_per_texel = glm::vec2(std::min(pixels_per_texel.x, pixels_per_texel.y));
  if (fit == TextureView::Fit::texels) pixels_per_texel = glm::vec2(1.0f);
  return {glm::floor(0.5f * (target_size - pixels_per_texel * texture_size)), 1.0f / pixels_per_texel};
}

/// One that can be divided by.
glm::vec2 proper(glm::vec2 range, bool log_scale) {
  if (log_scale) range.x = std::max({range.x, 1e-6f * range.y, 1e-30f});
  return {range.x, std::max(range.y, range.x + std::max(1e-6f * std::abs(range.x), 1e-30f))};
}

int nearest_layer(const gl::Texture& texture, int layer) { return std::clamp(layer, 0, texture.size().z - 1); }

/// Numbers of texels as they are copied to the host, all four channels but of depth.
template <class T>
std::vector<T> read_texels(const gl::Texture& texture, const TexelKind& kind, glm::ivec3 at, glm::ivec2 size) {
  GLenum format = kind.type == GL_FLOAT ? GL_RGBA : GL_RGBA_INTEGER;
  if (kind.depth) format = GL_DEPTH_COMPONENT;
  std::vector<T> texels(size_t(size.x) * size_t(size.y) * (kind.depth ? 1 : 4));
  glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);
  glGetTextureSubImage(texture.id(), 0, at.x, at.y, at.z, size.x, size.y, 1, format, kind.type,
                       GLsizei(texels.size() * sizeof(T)), texels.data());
  gl::throw_on_error();
  return texels;
}

std::vector<double> read_numbers(const gl::Texture& texture, const TexelKind& kind, glm::ivec3 at, glm::ivec2 size) {
  const auto as_doubles = [](const auto& texels) { return std::vector<double>(texels.begin(), texels.end()); };
  switch (kind.type) {
    case GL_UNSIGNED_INT:
      return as_doubles(read_texels<GLuint>(texture, kind, at, size));
    case GL_INT:
      return as_doubles(read_texels<GLint>(texture, kind, at, size));
    default:
      return as_doubles(read_texels<GLfloat>(texture, kind, at, size));
  }
}

glm::vec2 hundredths(std::vector<double> numbers) {
  if (numbers.empty()) return {0.0f, 1.0f};
  const auto at = [&](double share) {
    const auto place = numbers.begin() + std::ptrdiff_t(share * double(numbers.size() - 1));
    std::nth_element(numbers.begin(), place, numbers.end());
    return float(*place);
  };
  const float low = at(0.01), high = at(0.99);
  return {low, high > low ? high : low + std::max(std::abs(low), 1.0f)};
}

}  // namespace

TexelKind texel_kind(const gl::Texture& texture) {
  TexelKind kind;
  kind.target = GLenum(texture_parameter(texture, GL_TEXTURE_TARGET));
  kind.depth = level_parameter(texture, GL_TEXTURE_DEPTH_SIZE) > 0;
  kind.channels = kind.depth ? 1 : 0;
  for (GLenum size : {GL_TEXTURE_RED_SIZE, GL_TEXTURE_GREEN_SIZE, GL_TEXTURE_BLUE_SIZE, GL_TEXTURE_ALPHA_SIZE})
    kind.channels += level_parameter(texture, size) > 0 ? 1 : 0;
  const auto type = GLenum(level_parameter(texture, GL_TEXTURE_RED_TYPE));
  if (type == GL_INT || type == GL_UNSIGNED_INT) kind.type = type;
  return kind;
}

const gl::Program& TextureView::program_for(const TexelKind& kind) {
  const bool layered = kind.target != GL_TEXTURE_2D;
  const size_t type = kind.type == GL_FLOAT ? 0 : kind.type == GL_INT ? 1 : 2;
  // An array and a volume are fetched alike, but through samplers of different types.
  std::optional<gl::Program>& program = programs_[3 * type + (layered ? kind.target == GL_TEXTURE_3D ? 2 : 1 : 0)];
  if (!program) {
    const char* prefix[] = {"", "i", "u"};
    const char* dimensions = kind.target == GL_TEXTURE_3D ? "3D" : layered ? "2DArray" : "2D";
    std::vector<std::string> defines{"VIEWED_SAMPLER " + std::string(prefix[type]) + "sampler" + dimensions};
    if (layered) defines.emplace_back("LAYERED");
    program = gl::Program::raster("shared/fullscreen.vert.glsl", "screen/views/texture_view.frag.glsl", defines);
  }
  return *program;
}

void TextureView::run(const gl::Texture& texture, const Options& options, const gl::Framebuffer& target,
                      gl::PassTimer& timer) {
  const auto scope = timer.scope(name);
  const gl::Program& program = program_for(texel_kind(texture));
  const Place at = place(texture.size(), options.fit, target.size());
  gl::begin_fullscreen_pass();
  target.bind();
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);  // whoever has written it may not have thought of this
  texture.bind(VIEWED_TEXTURE_UNIT);
  program.set("layer", nearest_layer(texture, options.layer));
  program.set("first_pixel", at.first_pixel);
  program.set("texels_per_pixel", at.texels_per_pixel);
  program.set("range", proper(options.range, options.log_scale));
  program.set("log_scale", int(options.log_scale));
  program.set("channel", int(options.channel));
  program.set("encode", int(options.encode));
  program.use();
  gl::draw_fullscreen_triangle();
}

std::optional<glm::ivec2> TextureView::texel_at(glm::ivec2 texture_size, Fit fit, glm::ivec2 target_size,
                                                glm::vec2 pixel) {
  const Place at = place(texture_size, fit, target_size);
  const glm::ivec2 texel(glm::floor((pixel - at.first_pixel) * at.texels_per_pixel));
  if (glm::any(glm::lessThan(texel, glm::ivec2(0))) || glm::any(glm::greaterThanEqual(texel, texture_size))) return {};
  return texel;
}

TexelValue texel(const gl::Texture& texture, int layer, glm::ivec2 xy) {
  TexelValue result{.kind = texel_kind(texture)};
  const glm::ivec2 nearest = glm::clamp(xy, glm::ivec2(0), glm::ivec2(texture.size()) - 1);
  const std::vector<double> numbers =
      read_numbers(texture, result.kind, {nearest, nearest_layer(texture, layer)}, {1, 1});
  for (int c = 0; c < result.kind.channels; ++c) result.value[c] = numbers[size_t(c)];
  return result;
}

glm::vec2 automatic_range(const gl::Texture& texture, int layer, Channel channel, bool log_scale) {
  constexpr size_t most_texels = 1 << 18;
  const TexelKind kind = texel_kind(texture);
  const std::vector<double> all =
      read_numbers(texture, kind, {0, 0, nearest_layer(texture, layer)}, glm::ivec2(texture.size()));
  const size_t stride = kind.depth ? 1 : 4, texels = all.size() / stride;
  std::vector<double> numbers;
  const auto add = [&](double v) {
    if (std::isfinite(v) && (!log_scale || v > 0.0)) numbers.push_back(v);
  };
  for (size_t i = 0; i < texels; i += 1 + texels / most_texels) {
    const double* v = &all[i * stride];
    const int colors = std::min(kind.channels, 3);
    if (channel == Channel::rgb) {
      for (int c = 0; c < colors; ++c) add(v[c]);
    } else if (channel == Channel::length) {
      double squared = 0.0;
      for (int c = 0; c < colors; ++c) squared += v[c] * v[c];
      add(std::sqrt(squared));
    } else if (const int c = int(channel) - VIEW_RED; c < kind.channels) {
      add(v[c]);
    }
  }
  return hundredths(std::move(numbers));
}

}  // namespace volgi::screen
