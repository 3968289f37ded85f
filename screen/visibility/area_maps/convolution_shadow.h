#pragma once
#include "screen/visibility/area_maps/area_light_shadow.h"

namespace volgi::screen {

/// Pass "screen/visibility/area_maps/convolution_shadow": Fourier basis images of the depth maps and their mipmaps.
/// Dong et al. 2009, §4; we depart: the step is sharpened, depths are normalised by what each layer sees, the filter
/// follows the map's own scale unless Filter::printed (shaders/screen/visibility/area_maps/convolution_basis.glsl and
/// convolution_shadow.glsl). Cost: 16 terms a texel; a look-up reads seven filtered texels.
class ConvolutionShadow final : public AreaLightShadow {
 public:
  static constexpr const char* name = "screen/visibility/area_maps/convolution_shadow";
  enum class BasisFormat { rgba8, rgba16 };
  /// Basis: 8 bits as in the paper, unless asked for more. Basis times depth: 16 bits (there half floats), depth:
  /// float.
  ConvolutionShadow(int resolution, int layers, Filter filter = Filter::map, BasisFormat format = BasisFormat::rgba8);

  void run(const ParaboloidDepthMaps& maps, gl::PassTimer& timer) override;
  std::string define() const override;
  void bind(const ParaboloidDepthMaps& maps, const gl::Program& program) const override;
  size_t bytes() const override;
  void list_textures(std::vector<NamedTexture>& list) const override {
    list_texture(list, name, "basis", basis_);
    list_texture(list, name, "basis times depth", basis_depth_);
    list_texture(list, name, "depth", depth_);
    list_texture(list, name, "farthest", farthest_);
  }

 private:
  Filter filter_;
  BasisFormat format_;
  gl::Texture basis_, basis_depth_, depth_, farthest_;
  gl::Program range_program_, basis_program_;
};

}  // namespace volgi::screen
