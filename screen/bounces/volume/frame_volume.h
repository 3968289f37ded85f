#pragma once
#include <memory>

#include "core/gl/pass_timer.h"
#include "core/gl/scene_buffers.h"
#include "propagation/light_in/final_gather_cpu.h"
#include "propagation/radiance_volume_gl.h"
#include "propagation/volume_options.h"
#include "screen/base/gbuffer.h"
#include "screen/base/reflective_shadow_map.h"
#include "screen/bounces/volume/contacts.h"
#include "screen/bounces/volume/reflected_flux_gl.h"

namespace volgi::screen {

/// What the volume did, for --stats.
struct VolumeReport {
  bool on_gpu = false;
  bool coarse_start = false;  // SchemeOptions::coarse_start, as it was
  glm::ivec3 grid{0};
  size_t sides = 0;
  size_t pocket_cells = 0;  // voxel/white_pockets.h
  BounceReport bounces;
  FinalGatherCpu::Report gather;  // VolumeOptions::gather_rays
  size_t contact_pixels = 0;      // Contacts
  glm::vec3 injected{0.0f};       // flux that lit and emissive surfaces send [W]
  glm::vec3 lost{0.0f};           // and what found no side, or looks out of the grid at its rim [W]
  size_t memory_bytes = 0;
};

/// The volume subsystem's part of a frame, wherever it runs: light in, propagation, its light on every pixel.
class FrameVolume {
 public:
  static constexpr const char* product_name = "the volume";
  virtual ~FrameVolume() = default;
  /// Virtual lights are there, what is seen of them is not yet: a copy to the host may begin.
  virtual void lights_ready(const VirtualLightListGl& /*lights*/, const VirtualLightSubdivision* /*subdivision*/,
                            gl::PassTimer& /*timer*/) {}
  /// Of pictures that are averaged (core/sample_sequence.h), the one that run() is for.
  virtual void set_sample(int /*index*/) {}
  /// @param first_bounce  what a volume of VolumeOptions::Source::first_bounce starts from, else null.
  virtual void run(const gl::SceneBuffers& buffers, const ReflectiveShadowMap& maps, const GBuffer& gbuffer,
                   const Camera& camera, const FirstBounce* first_bounce, gl::PassTimer& timer) = 0;
  /// After run(), where indirect() is one of the picture's layers: it gets what all of them lack beside surfaces that
  /// are brightly lit and nearer than cells are large (Contacts), where there are rays for it.
  virtual void add_contacts(const ContactPicture& /*picture*/, gl::PassTimer& /*timer*/) {}
  /// The scene has changed in place, its materials, textures and images apart: the next run meets it as a new volume
  /// would. @return false if this volume cannot follow, as when the bounds make another grid: make a new one then.
  virtual bool follow_scene() { return false; }
  /// After a first bounce on the screen: what starts on sides (emission's first reflection, the sky's) is direct(), not
  /// in indirect() with all the rest.
  virtual bool first_is_apart() const { return true; }
  virtual const gl::Texture& direct() const = 0;    // RGBA32F: first arrival of emission, reflected to the viewer
  virtual const gl::Texture& indirect() const = 0;  // RGBA32F [W m^-2 sr^-1]
  virtual void list_textures(std::vector<NamedTexture>& list) const = 0;
  /// Of the last run. Irradiance is by side, vec4 [W m^-2], `direct` of emission's arrival; null where the scheme has
  /// no sides (the papers').
  virtual const VoxelGridGl& voxels() const = 0;
  /// False where they are too many for buffers of the GPU: voxels() is a grid alone, and there are no values of sides.
  virtual bool sides_on_gpu() const { return true; }
  virtual const gl::Buffer* direct_irradiance() const { return nullptr; }
  virtual const gl::Buffer* indirect_irradiance() const { return nullptr; }
  /// indirect_irradiance() without the last order that VolumeOptions::bounces allows: what sides of a picture of so
  /// many bounces reflect. Made when it is asked for, once a run at most. Null where the scheme has no sides.
  virtual const gl::Buffer* indirect_irradiance_but_last(gl::PassTimer& /*timer*/) const { return nullptr; }
  /// Of the last run: flux A B0 per side, vec4 [W], that sides reflect of the light that comes in, before any
  /// transport, and what they emit in order of its own; null: there is none. On the CPU it is uploaded when it is asked
  /// for.
  struct SentFlux {
    const gl::Buffer* punctual = nullptr;
    const gl::Buffer* emitted = nullptr;
  };
  virtual SentFlux light_in() const { return {}; }
  /// Radiance in free space of what sides sent in the last run, in all orders; on the CPU, with what streams in from a
  /// sky. Light that the screen carries, as the first bounce of `hybrid`, is not in it. Null while an order may be
  /// under way that the next run goes on with, and where sides are not on the GPU. Made when it is first asked for
  /// after a run, and kept until the next, between frames: it makes GL objects and may wait for the GPU. Cost: a pass
  /// over the volume and more; 64 or 144 bytes a cell.
  virtual const RadianceVolumeGl* radiance(gl::PassTimer& timer) const = 0;
  /// Waits for the GPU; after a frame, not in one.
  virtual VolumeReport report() const = 0;
};

/// Memory that a volume is going to take [bytes] for pictures of a size, VolumeReport::memory_bytes, before anything is
/// allocated: what options.memory_limit is compared with. The sum of what its parts say of themselves.
size_t volume_bytes_expected(const Scene& scene, const VolumeOptions& options, bool on_gpu, glm::ivec2 size);

/// The same of either backend.
size_t volume_bytes_on_gpu(const Scene& scene, const VolumeOptions& options, glm::ivec2 size);
size_t volume_bytes_on_cpu(const Scene& scene, const VolumeOptions& options, glm::ivec2 size);

/// @param scene  must outlive the volume.
/// @throws Error as Frame; Error(over_limit) naming both figures above options.memory_limit; on the GPU as
///   refuse_on_gpu.
std::unique_ptr<FrameVolume> make_volume_on_gpu(const Scene& scene, const VolumeOptions& options, glm::ivec2 size);
std::unique_ptr<FrameVolume> make_volume_on_cpu(const Scene& scene, const VolumeOptions& options, glm::ivec2 size);

}  // namespace volgi::screen
