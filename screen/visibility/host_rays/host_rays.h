#pragma once
#include <memory>
#include <vector>

#include "core/gl/objects.h"
#include "core/visibility/embree_scene.h"
#include "shaders/shared/virtual_light.shared.h"

namespace volgi::screen {

/// What hides lights on emissive surfaces, by Embree's rays on the CPU: exact, and as fast as the CPU is. A gather
/// writes down which ways it asks for (shaders/screen/gather/area/gather.comp.glsl, ASK) and finds the answers there.
/// Waits for the GPU each time, so it is for devices that are the CPU, and for telling what voxels get wrong.
class HostRays {
 public:
  static constexpr const char* product_name = "rays of the host";
  /// @param scene  must outlive this. Builds the acceleration structure.
  explicit HostRays(const Scene& scene);
  void scene_moved();

  /// Of one dispatch: each pixel asks for lights `first`, `first` + `shares` ... below `end` of every group of
  /// `per_group` that has a bit.
  struct Asked {
    size_t pixels;
    int per_group, shares, first, end;
  };
  /// Clears the bits of lights that are hidden.
  /// @param askers  position and geometric normal of each pixel, two vec4.
  /// @param questions  uvec2 for each pixel and member.
  void answer(const Asked& asked, const std::vector<shared::VirtualLight>& lights, const gl::Buffer& askers,
              const gl::Buffer& questions) const;

 private:
  const Scene& scene_;
  std::unique_ptr<EmbreeScene> embree_;
};

}  // namespace volgi::screen
