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
  /// @param triangles  of the same scene, from another frame; null: uploaded anew.
  Frame(const Scene& scene, const FrameOptions& options, Recipe recipe,
        std::shared_ptr<gl::SceneBuffers> triangles = nullptr);
  ~Frame();
  Frame(const Frame&) = delete;
  Frame& operator=(const Frame&) = delete;

  void render(const Camera& camera, gl::PassTimer& timer);
  /// Of pictures that the caller averages, however many they will be (core/sample_sequence.h), the one that render()
  /// makes next: BLEND covers other pixels; with `jitter` pixels are looked at elsewhere than in their centres, and
  /// virtual lights are others. Picture 0 is what a frame makes that nobody has told.
  void set_sample(int index, bool jitter);
  /// The scene has changed in place (SceneSource::move): meshes, lights, bounds and origin, but neither materials nor
  /// textures nor images. The next render() shows what a new Frame would, unless options have stages start from their
  /// last answer; programs, textures, maps and buffers stay. Where the bounds make another grid the volume is made
  /// anew: a grid that stands still is faster and does not flicker (SceneFile::at(time, box)). Pass
  /// "screen/frame/follow_scene": vertices, emissive surfaces, on the CPU Embree's tree.
  /// @throws Error as the constructor.
  void follow_scene(gl::PassTimer& timer);
  const gl::Texture& radiance() const { return compose_.radiance(); }

  /// Of the layers that options.light asks for, render() and compose() sum those that hold some of these paths.
  /// Everything is computed all the same.
  void show(LightPaths paths) { shown_ = paths; }
  /// radiance() of the last frame's layers once more, after show(). Needs a frame before.
  void compose(gl::PassTimer& timer);
  /// Of the last frame, those of its end first: which paths come together.
  const std::vector<RadianceLayer>& layers() const { return layers_; }
  /// Light that there is in the scene, is asked for and carried: layers may name more.
  LightPaths wanted() const { return wanted_; }
  /// What stages of the last frame made, for pictures of it.
  const Products& products() const { return products_; }
  const GBuffer& gbuffer() const { return gbuffer_; }
  const ReflectiveShadowMap& shadow_maps() const { return shadow_maps_; }
  const std::shared_ptr<gl::SceneBuffers>& triangles() const { return buffers_; }
  /// Of the last frame, in the order in which they are written.
  std::vector<NamedTexture> textures() const;
  /// Stages that the picture has, in their order.
  std::vector<const StageType*> stages() const;
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
  std::vector<const gl::Texture*> shown() const;

  const Scene& scene_;
  FrameOptions options_;
  Recipe recipe_;
  LightPaths wanted_;
  LightPaths shown_ = LightPaths::all();
  std::shared_ptr<gl::SceneBuffers> buffers_;
  ReflectiveShadowMap shadow_maps_;
  GBuffer gbuffer_;
  Direct direct_;
  int sample_ = 0;
  std::optional<SkySeen> sky_seen_;  // where there is a sky
  Compose compose_;
  std::vector<Step> steps_;
  std::vector<RadianceLayer> layers_;
  Products products_;
};

}  // namespace volgi::screen
