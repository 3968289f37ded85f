#pragma once
#include <span>
#include <vector>

#include "core/camera.h"
#include "core/gl/objects.h"
#include "core/gl/pass_timer.h"
#include "core/visibility/embree_scene.h"
#include "propagation/light_in/final_gather_cpu.h"
#include "screen/base/gbuffer.h"

namespace volgi::screen {

struct ContactOptions {
  int paths = 1 << 19;  // of a picture, at most; 0: there are no contacts
};

/// A picture whose contacts are wanted.
struct ContactPicture {
  const GBuffer& gbuffer;
  const Camera& camera;
  std::span<const gl::Texture* const> layers;  // RGBA32F [W m^-2 sr^-1]: together all of its indirect light
  int paths = 0;                               // ContactOptions
  int sample = 0;                              // of pictures that are averaged: other paths
};

/// Pass "screen/bounces/volume/contacts": pixels near sides that what is near alone lights three times as bright as the
/// mean side is by everything have their indirect light by paths (propagation/light_in/contact_light_cpu.h), as far as
/// what these say is more than their noise. No more pixels than paths pay for, those with the most such light. Waits
/// for the GPU. Cost: a look at what rays of sides meet, 3 ns a ray; where that finds something, some 1 us for each
/// path, and five pictures to the host and back.
class Contacts {
 public:
  static constexpr const char* name = "screen/bounces/volume/contacts";
  static constexpr int LEAST_PATHS_OF_PIXEL = 64, MOST_PATHS_OF_PIXEL = 512;

  /// @param gather  after run(), of `voxels`. @param positions  of the G-buffer.
  /// @param into  one of the picture's layers: gets the difference.
  void run(const VoxelGrid& voxels, const EmbreeScene& embree, FinalGatherCpu& gather, const ContactPicture& picture,
           std::span<const glm::vec4> positions, const gl::Texture& into, gl::PassTimer& timer);
  size_t pixels() const { return pixels_; }  // of the last run

 private:
  size_t pixels_ = 0;
};

}  // namespace volgi::screen
