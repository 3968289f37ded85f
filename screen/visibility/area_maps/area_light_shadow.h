#pragma once
#include <memory>
#include <string>

#include "core/gl/pass_timer.h"
#include "core/gl/program.h"
#include "screen/base/named_texture.h"
#include "screen/visibility/area_maps/paraboloid_depth_maps.h"
#include "screen/visibility/area_maps/virtual_area_lights.h"

namespace volgi::screen {

/// How much of each virtual area light a point sees. One method, one subclass, one shader file: a gather is compiled
/// with define() and then calls `float area_light_visibility(int k, VirtualAreaLight light, vec3 position, vec3
/// normal)` of shaders/screen/visibility/area_maps/area_light_shadow.glsl.
class AreaLightShadow {
 public:
  enum class Method {
    convolution,        // Dong et al. 2009, §4: convolution soft shadow maps, 4 Fourier terms
    percentage_closer,  // the same maps, compared depths averaged over the penumbra's filter
    single,             // the same maps, one comparison: hard
  };
  /// Width of convolution's filters in the map.
  enum class Filter {
    map,      // of the angle by the map's scale there, 4 / (1 + r^2) a width
    printed,  // Dong et al. 2009, §4.2: the angle over pi, wherever in the map
  };
  static std::unique_ptr<AreaLightShadow> make(Method method, Filter filter, int resolution, int layers);

  virtual ~AreaLightShadow() = default;
  /// Filters the maps for this frame.
  virtual void run(const ParaboloidDepthMaps& maps, gl::PassTimer& timer) = 0;
  virtual std::string define() const = 0;
  /// Textures (SHADOW_*_UNIT of shaders/screen/visibility/area_maps/slots.shared.h); sets the uniforms of `program`
  /// (compiled with define()).
  virtual void bind(const ParaboloidDepthMaps& maps, const gl::Program& program) const = 0;
  virtual size_t bytes() const = 0;
  virtual void list_textures(std::vector<NamedTexture>& /*list*/) const {}
};

}  // namespace volgi::screen
