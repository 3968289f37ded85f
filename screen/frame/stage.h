#pragma once
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/gl/pass_timer.h"
#include "core/virtual_light_list.h"
#include "screen/base/named_texture.h"
#include "screen/frame/frame_data.h"
#include "screen/frame/frame_options.h"
#include "screen/frame/frame_report.h"
#include "screen/frame/parameter.h"

namespace volgi::screen {

/// The question that a technique answers (docs/architecture.md). Stages of a recipe stand in this order.
enum class Slot { sources, lights, visibility, gather, bounces };
const char* slot_name(Slot slot);

/// What a stage does in a picture with given options, before anything of it exists.
struct StageRole {
  bool active = true;               // false: with these options it has nothing to do
  std::vector<Product> needs = {};  // made by stages before it, or the recipe is refused
  std::vector<Product> uses = {};   // taken where there are some
  std::vector<Product> makes = {};
  /// Light that its layers hold. Nothing of it wanted and nothing of `makes` taken: the stage is left out.
  struct Light {
    LightPaths paths;
    LightShare share = LightShare::whole;
  };
  std::vector<Light> adds = {};
  LightPaths lacks = {};  // what it carries otherwise, but cannot with these options: warned about, not refused
};

/// What a stage is made for.
struct StageContext {
  const Scene& scene;  // outlives the stage; may change in place, which scene_changed() says
  const FrameOptions& options;
  LightPaths wanted;                  // what the picture shows, and the recipe claims
  const std::vector<Product>& taken;  // by stages after this one
  template <class T>
  bool takes() const {
    for (const Product& p : taken) {
      if (p == product<T>()) return true;
    }
    return false;
  }
};

/// A technique at work: one or a few passes. Where it needs OpenGL, a gl::Context is current.
class Stage {
 public:
  virtual ~Stage() = default;
  /// Stages of the slot `lights` have run, later ones have not: what takes long may begin (a copy to the host).
  virtual void lights_ready(FrameData& /*frame*/, gl::PassTimer& /*timer*/) {}
  /// Takes and lends products, adds layers: of the paths and shares that its role names, fewer where there is no such
  /// light.
  virtual void run(FrameData& frame, gl::PassTimer& timer) = 0;
  /// The scene has changed in place (Frame::follow_scene): the next run shows what a new stage would.
  virtual void scene_changed() {}
  /// What the last frame was made of, and memory_bytes. Waits for the GPU; after a frame, not in one.
  virtual void report(FrameReport& report) const = 0;
  /// Puts what the last frame was lit by into `list`; a stage that chooses among another's replaces those. Waits.
  virtual void list_lights(VirtualLightList& /*list*/) const {}
  /// Textures that the last frame's run has written, under the names of their passes.
  virtual void list_textures(std::vector<NamedTexture>& /*list*/) const {}
  /// A line for people before the first frame: where it runs, what it takes. Empty: nothing to say.
  virtual std::string announcement() const { return {}; }
};

struct Needs;

/// A technique in the registry.
struct StageType {
  const char* name;  // its leaf: "SLOT/TECHNIQUE"
  Slot slot;
  std::span<const Parameter> parameters;
  /// @throws Error(usage) for options that do not go together.
  StageRole (*role)(const FrameOptions& options);
  std::unique_ptr<Stage> (*make)(const StageContext& context);
  /// Its figures in --stats where it has no part in the picture, so that their names are always there. May be null.
  void (*report_nothing)(FrameReport& report) = nullptr;
  /// Gives its parameters what a quality asks of the scene, from the defaults of its options (quality.h). Null:
  /// nothing.
  void (*suit)(const Needs& needs, TypeMap& settings) = nullptr;
};

/// A picture's stages: what --gi names.
struct Recipe {
  const char* name;
  const char* help;
  std::vector<const StageType*> stages;         // in the order of their slots
  LightPaths claims;                            // paths that it carries, besides those of every picture (BASE_PATHS)
  void (*preset)(TypeMap& settings) = nullptr;  // settings that the name stands for; may be null
};

}  // namespace volgi::screen
