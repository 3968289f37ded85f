#pragma once
#include <memory>
#include <optional>

#include "core/gl/pass_timer.h"
#include "propagation/volume_options.h"
#include "screen/base/compose.h"
#include "screen/base/direct.h"
#include "screen/base/frame_voxels.h"
#include "screen/base/reflective_shadow_map.h"
#include "screen/bounces/volume/frame_volume.h"
#include "screen/frame/bounce_budget.h"
#include "screen/gather/interleaved/area_light_gather.h"
#include "screen/gather/interleaved/near_lights.h"
#include "screen/gather/strided/virtual_light_gather.h"
#include "screen/lights/resample/choose_virtual_lights.h"
#include "screen/lights/rsm/virtual_lights.h"
#include "screen/visibility/negative/negative_lights.h"

namespace volgi::screen {

/// Where the volume is computed: on the GPU, or by its CPU twin (whose answer is uploaded). `automatic` takes the CPU
/// where GL is a software rasterizer, and the GPU elsewhere.
enum class Backend { automatic, gpu, cpu };
/// What `automatic` means with the current gl::Context.
bool runs_on_gpu(Backend backend);

struct FrameOptions {
  GiMode gi = GiMode::volume;
  LightPart light = LightPart::full;
  glm::ivec2 size{512, 512};
  VolumeOptions volume;
  Backend backend = Backend::automatic;
  ReflectiveShadowMap::Resolution shadow_resolution;
  VirtualLightOptions virtual_lights;
  int choose_one_of = 16;  // candidates for each virtual light (ChooseVirtualLights); 1: take them as they come
  float near_zone = 4.0f;  // val, hybrid: areas of a virtual light near which its parts light (NearLights); 0: none
  NegativeLightOptions negative_lights;
  GatherOptions gather;
  VirtualAreaLightOptions area_lights;
  AreaLightShadow::Method area_light_shadow = AreaLightShadow::Method::single;
  int area_light_map = 256;  // texels on each side of an area light's map
  AreaLightGatherOptions area_light_gather;
};

/// What a frame was made of, for --stats.
struct FrameReport {
  VolumeReport volume;
  int virtual_lights = 0;
  int negative_lights = 0;
  int area_lights = 0;
  float coarse_share = 0.0f;  // of the pixels whose light comes from coarse ones
  size_t memory_bytes = 0;    // of GL objects, and of the volume wherever it lies
};

/// The frame: which passes run, and in which order. One scene, one picture size; render() as often as wanted. Lights
/// may change between frames as they like; geometry with follow_scene(). Needs a current gl::Context.
class Frame {
 public:
  /// @throws Error as make_grid and gl::Buffer do; Error(usage) for volume options that make no sense together;
  ///   Error(over_limit) above options.volume.memory_limit.
  Frame(const Scene& scene, const FrameOptions& options);
  ~Frame();
  Frame(const Frame&) = delete;
  Frame& operator=(const Frame&) = delete;

  void render(const Camera& camera, gl::PassTimer& timer);
  /// The scene has changed in place (SceneSource::move): meshes, lights, bounds and origin, but neither materials nor
  /// textures nor images. The next render() shows what a new Frame would, unless VolumeOptions::warm_start or
  /// passes_a_run have it start from the last answer; programs, textures, maps and buffers stay. Where the bounds make
  /// another grid the volume is made anew: a grid that stands still is faster and does not flicker
  /// (SceneFile::at(time, box)). Pass "screen/frame/follow_scene": vertices, emissive surfaces, on the CPU Embree's
  /// tree.
  /// @throws Error as the constructor.
  void follow_scene(gl::PassTimer& timer);
  const gl::Texture& radiance() const;
  /// Waits for the GPU; after a frame, not in one.
  FrameReport report() const;
  /// Virtual lights of the last frame, negative ones last; empty where there are none. Waits for the GPU.
  VirtualLightList virtual_lights() const;

 private:
  void follow_with_volume();
  void follow_with_first_bounce();
  void make_first_bounce();
  void drop_first_bounce();
  void light_by_area_lights(const VirtualLightListGl& lights, gl::PassTimer& timer);
  void light_by_virtual_lights(const VirtualLightListGl& lights, const Camera& camera, gl::PassTimer& timer);
  float scene_diagonal_m() const { return glm::distance(scene_.bounds_min, scene_.bounds_max); }
  const VirtualLightListGl& light_list() const;

  const Scene& scene_;
  FrameOptions options_;
  BounceBudget budget_;
  gl::SceneBuffers buffers_;
  ReflectiveShadowMap shadow_maps_;
  GBuffer gbuffer_;
  Direct direct_;
  Compose compose_;
  // None when nobody asks for their light.
  std::unique_ptr<FrameVolume> volume_;
  std::unique_ptr<VirtualLights> virtual_lights_;
  std::unique_ptr<ChooseVirtualLights> choose_virtual_lights_;
  std::unique_ptr<VirtualLightParts> light_parts_;
  std::unique_ptr<NearLights> near_lights_;
  std::unique_ptr<FrameVoxels> voxels_;
  std::unique_ptr<NegativeLights> negative_lights_;
  std::unique_ptr<VirtualLightGather> virtual_light_gather_;
  std::unique_ptr<VirtualAreaLights> area_lights_;
  std::unique_ptr<ParaboloidDepthMaps> area_light_maps_;
  std::unique_ptr<AreaLightShadow> area_light_shadow_;
  std::unique_ptr<AreaLightGather> area_light_gather_;
};

}  // namespace volgi::screen
