#pragma once
#include "core/gl/objects.h"
#include "core/gl/pass_timer.h"
#include "core/gl/program.h"
#include "screen/base/gbuffer.h"
#include "screen/base/named_texture.h"
#include "screen/base/work_list.h"
#include "screen/lights/resample/virtual_light_subdivision.h"

namespace volgi::screen {

/// Passes "screen/gather/interleaved/near_lights_tiles" and "screen/gather/interleaved/near_lights": the light that
/// virtual lights send to what is near them, from their sub-lights (VirtualLightSubdivision). A disk's form factor is
/// right only from afar: surfaces that meet a lit one got dark corners with bright spots, nearly all of the error that
/// 1024 lights left. The share of a light that its coarse sub-lights carry falls from 1 to 0 between `zone` and twice
/// that, in squared distance over area (far_share() of shaders/shared/near_light.shared.h), and nearer by half their
/// fine ones follow by the same rule; the gather takes the rest, which is smooth. Nothing is taken to hide a light from
/// what is so near: an area light's map, drawn from elsewhere, knows nothing of such ways. Tiles of 8 x 8 pixels find
/// their lights first, among those of 32 x 32; those without any are left out. Cost: lights for each 1024 pixels; about
/// eight sub-lights for each light near a pixel and in front of it.
class NearLights {
 public:
  static constexpr const char* tiles_name = "screen/gather/interleaved/near_lights_tiles";
  static constexpr const char* name = "screen/gather/interleaved/near_lights";
  NearLights(glm::ivec2 size, float zone);

  void run(const GBuffer& gbuffer, const VirtualLightListGl& lights, const VirtualLightSubdivision& subdivision,
           gl::PassTimer& timer);

  const gl::Texture& direct() const { return direct_; }      // RGBA32F: arrival of emission [W m^-2 sr^-1]
  const gl::Texture& indirect() const { return indirect_; }  // RGBA32F: the first reflection of punctual light
  size_t bytes() const;
  void list_textures(std::vector<NamedTexture>& list) const {
    list_texture(list, name, "direct", direct_);
    list_texture(list, name, "indirect", indirect_);
  }

 private:
  void find_tiles(const GBuffer& gbuffer, const VirtualLightListGl& lights, const VirtualLightSubdivision& subdivision,
                  gl::PassTimer& timer);

  glm::ivec2 size_;
  float zone_;
  gl::Texture direct_, indirect_;
  WorkList list_;                           // of tiles
  gl::Buffer boxes_, masks_, large_masks_;  // of tiles: shaders/screen/gather/interleaved/near_lights.glsl
  gl::Program boxes_program_, large_program_, tiles_program_, gather_;
};

}  // namespace volgi::screen
