#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/gl/pass_timer.h"
#include "screen/base/compose.h"
#include "screen/base/direct.h"
#include "screen/base/gbuffer.h"
#include "screen/base/reflective_shadow_map.h"
#include "screen/base/sky_seen.h"
#include "screen/frame/frame_options.h"
#include "screen/frame/frame_report.h"
#include "screen/frame/plan.h"
#include "screen/frame/stage.h"

namespace volgi::screen {

/// The frame: passes of every picture, and the stages of a recipe between them. One scene, one picture size; render()
/// as often as wanted. Lights may change between frames as they like; geometry with follow_scene(). Needs a current
/// gl::Context.
class Frame {
 public:
  /// The recipe that options.recipe names, or the default one.
  /// @throws Error(usage) as find_recipe(), plan_picture() and the stages do (grids, options that make no sense
  ///   together), Error(over_limit) above memory limits.
  Frame(const Scene& scene, const FrameOptions& options);
  /// A recipe of one's own. @param recipe  copied; its stage types must outlive the frame.
  Frame(const Scene& scene, const FrameOptions& options, Recipe recipe);
  ~Frame();
  Frame(const Frame&) = delete;
  Frame& operator=(const Frame&) = delete;

  void render(const Camera& camera, gl::PassTimer& timer);
  /// Of `count` pictures that the caller averages, the one that render() makes next: BLEND covers other pixels, and
  /// with `jitter` pixels are looked at in other places (a Halton sequence) than their centres.
  void set_sample(int index, int count, bool jitter);
  /// The scene has changed in place (SceneSource::move): meshes, lights, bounds and origin, but neither materials nor
  /// textures nor images. The next render() shows what a new Frame would, unless options have stages start from their
  /// last answer; programs, textures, maps and buffers stay. Where the bounds make another grid the volume is made
  /// anew: a grid that stands still is faster and does not flicker (SceneFile::at(time, box)). Pass
  /// "screen/frame/follow_scene": vertices, emissive surfaces, on the CPU Embree's tree.
  /// @throws Error as the constructor.
  void follow_scene(gl::PassTimer& timer);
  const gl::Texture& radiance() const { return compose_.radiance(); }
  /// Waits for the GPU; after a frame, not in one.
  FrameReport report() const;
  /// Virtual lights of the last frame, those to subtract last; empty where there are none. Waits for the GPU.
  VirtualLightList virtual_lights() const;
  /// What its stages say before the first frame, a line each.
  std::vector<std::string> announcements() const;

 private:
  struct Step {
    Plan::Step plan;
    std::unique_ptr<Stage> stage;
  };
  void follow_with_stages();
  std::unique_ptr<Stage> take_stage(std::vector<Step>& from, const Plan::Step& step);
  void warn_of_missing_light(LightPaths missing) const;
  std::vector<const gl::Texture*> shown(std::span<const RadianceLayer> layers) const;

  const Scene& scene_;
  FrameOptions options_;
  Recipe recipe_;
  LightPaths wanted_;
  gl::SceneBuffers buffers_;
  ReflectiveShadowMap shadow_maps_;
  GBuffer gbuffer_;
  Direct direct_;
  std::optional<SkySeen> sky_seen_;  // where there is a sky
  Compose compose_;
  std::vector<Step> steps_;
};

}  // namespace volgi::screen
