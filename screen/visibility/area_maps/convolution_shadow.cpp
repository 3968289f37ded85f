#include "screen/visibility/area_maps/convolution_shadow.h"

#include <bit>
#include <cassert>

#include "shaders/screen/visibility/area_maps/slots.shared.h"
#include "shaders/shared/group_sizes.shared.h"

namespace volgi::screen {
namespace {

gl::Texture mipmapped(GLenum format, int resolution, int layers) {
  gl::Texture t =
      gl::Texture::make_2d_array(format, resolution, resolution, layers, std::bit_width(unsigned(resolution)));
  t.filter(GL_LINEAR_MIPMAP_LINEAR, GL_LINEAR);
  return t;
}

}  // namespace

ConvolutionShadow::ConvolutionShadow(int resolution, int layers, Filter filter, BasisFormat format)
    : filter_(filter),
      format_(format),
      basis_(mipmapped(format == BasisFormat::rgba8 ? GL_RGBA8 : GL_RGBA16, resolution, 2 * layers)),
      basis_depth_(mipmapped(GL_RGBA16, resolution, 2 * layers)),
      depth_(mipmapped(GL_R32F, resolution, layers)),
      farthest_(gl::Texture::make_2d(GL_R32F, layers, 1)),
      range_program_(gl::Program::compute("screen/visibility/area_maps/convolution_shadow_range.comp.glsl")),
      basis_program_(
          gl::Program::compute("screen/visibility/area_maps/convolution_shadow.comp.glsl",
                               {format == BasisFormat::rgba8 ? "BASIS_FORMAT rgba8" : "BASIS_FORMAT STORED_RGBA16"})) {}

void ConvolutionShadow::run(const ParaboloidDepthMaps& maps, gl::PassTimer& timer) {
  const auto scope = timer.scope(name);
  const int resolution = maps.resolution();
  const int layers = maps.layers();
  assert(depth_.size() == glm::ivec3(resolution, resolution, layers));
  maps.distance().bind(DISTANCE_MAP_UNIT);
  farthest_.bind_image(FARTHEST_IMAGE, GL_WRITE_ONLY);
  range_program_.use();
  glDispatchCompute(GLuint(layers), 1, 1);
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
  farthest_.bind(FARTHEST_UNIT);
  basis_.bind_image(BASIS_IMAGE, GL_WRITE_ONLY);
  basis_depth_.bind_image(BASIS_DEPTH_IMAGE, GL_WRITE_ONLY);
  depth_.bind_image(BASIS_MEAN_IMAGE, GL_WRITE_ONLY);
  basis_program_.use();
  gl::dispatch({resolution, resolution, layers}, {SQUARE_GROUP, SQUARE_GROUP, 1});
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT | GL_FRAMEBUFFER_BARRIER_BIT);
  for (const gl::Texture* t : {&basis_, &basis_depth_, &depth_}) glGenerateTextureMipmap(t->id());
}

std::string ConvolutionShadow::define() const {
  return filter_ == Filter::printed ? "AREA_LIGHT_SHADOW_CONVOLUTION FILTER_AS_PRINTED"
                                    : "AREA_LIGHT_SHADOW_CONVOLUTION FILTER_OF_MAP";
}

void ConvolutionShadow::bind(const ParaboloidDepthMaps&, const gl::Program&) const {
  basis_.bind(SHADOW_BASIS_UNIT);
  basis_depth_.bind(SHADOW_BASIS_DEPTH_UNIT);
  depth_.bind(SHADOW_DEPTH_UNIT);
  farthest_.bind(SHADOW_FARTHEST_UNIT);
}

size_t ConvolutionShadow::bytes() const {
  const glm::ivec3 size = depth_.size();
  const size_t texels = size_t(size.x) * size_t(size.y) * size_t(size.z);
  const size_t texel_bytes = (format_ == BasisFormat::rgba8 ? 8 : 16) + 16 + 4;
  return texels * texel_bytes * 4 / 3;
}

}  // namespace volgi::screen
