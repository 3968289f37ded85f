#pragma once
#include <array>
#include <optional>

#include "core/gl/objects.h"
#include "core/gl/pass_timer.h"
#include "core/gl/program.h"
#include "shaders/screen/views/view_modes.shared.h"

namespace volgi::screen {

/// What a texture holds, as OpenGL says of it.
struct TexelKind {
  GLenum target = GL_TEXTURE_2D;  // or GL_TEXTURE_2D_ARRAY, GL_TEXTURE_3D
  GLenum type = GL_FLOAT;         // as shaders see numbers: GL_FLOAT, GL_INT, GL_UNSIGNED_INT
  int channels = 4;               // of depth 1
  bool depth = false;
};
TexelKind texel_kind(const gl::Texture& texture);

/// Pass "screen/views/texture_view": one layer of a texture in place of the picture: 2D, 2D array or 3D; floats, fixed
/// point, integers or depth; level 0, nearest. NaN is magenta, infinity cyan, grey what lies beside the texture. Cost:
/// one fullscreen pass.
class TextureView {
 public:
  static constexpr const char* name = "screen/views/texture_view";
  enum class Channel {
    rgb = VIEW_RGB,
    red = VIEW_RED,
    green = VIEW_GREEN,
    blue = VIEW_BLUE,
    alpha = VIEW_ALPHA,
    length = VIEW_LENGTH,  // of rgb
  };
  enum class Fit {
    aspect,   // as large as it can be with square texels, in the middle
    stretch,  // over the whole picture
    texels,   // a texel a pixel, in the middle
  };
  struct Options {
    int layer = 0;  // of an array, or z; nearest that there is
    glm::vec2 range{0.0f, 1.0f};
    bool log_scale = false;  // from range.x, at least a millionth of range.y
    Channel channel = Channel::rgb;
    bool encode = true;  // rgb through the sRGB curve, as light is; off for normals and positions. Others: viridis
    Fit fit = Fit::aspect;
  };

  /// @param target  RGBA8, overwritten. Compiles a program for the first texture of its kind.
  void run(const gl::Texture& texture, const Options& options, const gl::Framebuffer& target, gl::PassTimer& timer);

  /// The texel that run() shows at a place of the target; none beside the texture.
  /// @param pixel  (0, 0) is the bottom left corner, as in OpenGL.
  static std::optional<glm::ivec2> texel_at(glm::ivec2 texture_size, Fit fit, glm::ivec2 target_size, glm::vec2 pixel);

 private:
  const gl::Program& program_for(const TexelKind& kind);
  std::array<std::optional<gl::Program>, 9> programs_;  // by type, then by target
};

/// One texel's numbers: of channels that there are none, 0, 0, 0 and 1. Integers are exact.
struct TexelValue {
  TexelKind kind;
  glm::dvec4 value{0.0, 0.0, 0.0, 1.0};
};
/// Waits for the GPU: between frames, never in one. @param layer, xy  nearest that there is.
TexelValue texel(const gl::Texture& texture, int layer, glm::ivec2 xy);

/// A range for TextureView: from the lowest to the highest hundredth of the layer's finite numbers, for a log scale of
/// those above zero; of large layers a quarter of a million texels are looked at. {0, 1} where there are none.
/// Waits for the GPU: between frames. Cost: a copy of the layer to the host.
glm::vec2 automatic_range(const gl::Texture& texture, int layer, TextureView::Channel channel, bool log_scale = false);

}  // namespace volgi::screen
