#pragma once
#include <array>
#include <optional>

#include "core/gl/objects.h"
#include "core/gl/program.h"
#include "screen/base/named_texture.h"
#include "screen/base/smooth_pixels.h"
#include "screen/gather/multires/light_tree.h"
#include "screen/visibility/area_maps/light_clusters.h"

namespace volgi::screen {

/// Pass "screen/gather/multires/light_cut": irradiance of all virtual lights at the pixels of a list, by a soft cut
/// through their tree (LightTree), each node seen as far as its cluster is; what is nearer than half of a light's size
/// sees its parts in any case, as a cluster's map, drawn from elsewhere, knows nothing of such ways.
/// Cost a pixel: the nodes of its cut, and a look-up for each cluster in front of it.
class LightCut final : public SmoothLight {
 public:
  static constexpr const char* name = "screen/gather/multires/light_cut";
  /// @param shadow  which method its shader has.
  LightCut(glm::ivec2 size, const AreaLightShadow& shadow);

  /// What gather() shows from now on; must be there as long as it does.
  /// @param with_direct  some lights stand for emission.
  void look_at(const LightTree& tree, const LightClusters& clusters, bool with_direct);
  std::vector<const gl::Texture*> radiance() const override;
  void gather(const WorkList& list, int /*step_px*/, std::span<const gl::Texture> irradiance,
              gl::PassTimer& timer) override;

  const gl::Texture& direct() const { return direct_; }      // RGBA32F: arrival of emission [W m^-2 sr^-1]
  const gl::Texture& indirect() const { return indirect_; }  // RGBA32F: the first reflection of punctual light
  size_t bytes() const;
  void list_textures(std::vector<NamedTexture>& list) const {
    if (with_direct_) list_texture(list, name, "direct", direct_);
    list_texture(list, name, "indirect", indirect_);
  }

 private:
  const gl::Program& program();

  std::string shadow_define_;
  const LightTree* tree_ = nullptr;
  const LightClusters* clusters_ = nullptr;
  bool with_direct_ = false;
  gl::Texture direct_, indirect_;
  std::array<std::optional<gl::Program>, 2> programs_;  // without and with direct light
};

}  // namespace volgi::screen
