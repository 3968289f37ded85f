#include "screen/gather/subsplats/subsplats_stage.h"

#include <fmt/format.h>

#include <bit>

#include "core/error.h"
#include "core/light_shares.h"
#include "core/surface.h"
#include "screen/gather/subsplats/discontinuity_mipmaps.h"
#include "screen/gather/subsplats/flattened_buffer.h"
#include "screen/gather/subsplats/light_cache.h"
#include "screen/gather/subsplats/splat.h"
#include "screen/gather/subsplats/stencil_gather.h"
#include "screen/gather/subsplats/subsplat_refinement.h"
#include "screen/gather/subsplats/upsample.h"
#include "screen/lights/light_choice.h"
#include "screen/lights/patches/patches_stage.h"
#include "screen/visibility/area_maps/light_clusters.h"
#include "screen/visibility/negative/negative_lights.h"

namespace volgi::screen {

namespace {

using Options = SubsplatOptions;
using Discontinuity = DiscontinuityOptions;

constexpr const char* SUMS[] = {"gather", "splat"};
constexpr const char* REFINEMENTS[] = {"geometry", "compute"};
constexpr const char* CRITERIA[] = {
    "depth,normal", "derivative,normal", "depth,curvature", "derivative,curvature", "depth",
    "normal",       "derivative",        "curvature"};
constexpr const char* FORMS[] = {"point", "disk", "exact"};
constexpr const char* VISIBILITIES[] = {"none", "negative", "area_maps"};
constexpr const char* RENDERED[] = {"printed", "kept"};

constexpr Parameter PARAMETERS[] = {
    choice<Options>(
        {"multires.sum", "", "of lights at subsplats: gathered under a stencil, or splatted"}, SUMS,
        [](Options& o) -> auto& { return o.sum; }),
    choice<Options>(
        {"multires.refine", "", "how splat finds its subsplats: a geometry shader and transform feedback, or compute"},
        REFINEMENTS, [](Options& o) -> auto& { return o.refine; }),
    yes_no<Options>(
        {"multires.each_light", "", "splat refines subsplats for every light, by what it gives their quadrants"},
        [](Options& o) -> auto& { return o.each_light; }),
    number<Options>(
        {"multires.difference", "",
         "of irradiance between them, of all lights' power over the scene's diagonal squared"},
        {0, 1e6}, [](Options& o) -> auto& { return o.difference; }),
    choice<Discontinuity>(
        {"multires.criterion", "",
         "what divides a subsplat: discontinuities of depth or its derivative, and of normals "
         "or curvature"},
        CRITERIA, [](Discontinuity& o) -> auto& { return o.criterion; }),
    number<Discontinuity>(
        {"multires.depth", "", "range of depth that divides it, of the scene's diagonal"}, {0, 10},
        [](Discontinuity& o) -> auto& { return o.depth; }),
    number<Discontinuity>(
        {"multires.derivative", "", "of depth, in diagonals over the picture's height"}, {0, 1e6},
        [](Discontinuity& o) -> auto& { return o.derivative; }),
    number<Discontinuity>(
        {"multires.normal", "", "range of a component of normals"}, {0, 2},
        [](Discontinuity& o) -> auto& { return o.normal; }),
    number<Discontinuity>(
        {"multires.curvature", "", "chord between normals of neighbours"}, {0, 2},
        [](Discontinuity& o) -> auto& { return o.curvature; }),
    yes_no<Discontinuity>(
        {"multires.diagonals", "", "discontinuities of squares diagonal to a subsplat divide it, too"},
        [](Discontinuity& o) -> auto& { return o.diagonals; }),
    yes_no<Discontinuity>(
        {"multires.borders", "", "those of all squares beside it, too"},
        [](Discontinuity& o) -> auto& { return o.borders; }),
    number<Options>(
        {"multires.cells", "", "coarsest subsplats along the picture's longer side, at least"}, {1, 16384},
        [](Options& o) -> auto& { return o.cells; }),
    number<Options>(
        {"multires.finest", "pixels", "on a side of the finest subsplats, a power of two"}, {1, 4096},
        [](Options& o) -> auto& { return o.finest; }),
    choice<UpsampleOptions>(
        {"multires.upsample", "", "interpolates what was rendered as well, as printed, or keeps it"}, RENDERED,
        [](UpsampleOptions& o) -> auto& { return o.rendered; }),
    number<UpsampleOptions>(
        {"multires.detail", "", "alpha of surface detail, by how much a pixel faces the viewer"}, {0, 1},
        [](UpsampleOptions& o) -> auto& { return o.detail; }),
    choice<Options>(
        {"multires.form", "", "what a light gives: eq. 3.2, the disk of eq. 4.1, or ours"}, FORMS,
        [](Options& o) -> auto& { return o.form; }),
    yes_no<Options>(
        {"multires.shine", "", "lights shine on materials as they are (each_light finds highlights), not on matt ones"},
        [](Options& o) -> auto& { return o.shine; }),
    number<Options>(
        {"multires.threshold", "",
         "tau, of a light's intensity: patches that may give more are divided (hierarchical)"},
        {1e-4, 1}, [](Options& o) -> auto& { return o.threshold; }),
    choice<Options>(
        {"multires.visibility", "", "of lights: none as printed, less negative lights, or as far as clusters see"},
        VISIBILITIES, [](Options& o) -> auto& { return o.visibility; }),
};

[[noreturn]] void refuse(const std::string& why) { throw Error(ExitCode::usage, why); }

void check(const FrameOptions& options) {
  const auto& o = options.of<Options>();
  if (!std::has_single_bit(unsigned(o.finest)))
    refuse(fmt::format("multires.finest={}: must be a power of two, such as 1 or 4", o.finest));
  if (o.sum == Options::Sum::splat && lights_are_a_hierarchy(options))
    refuse(
        "multires.sum=splat: fragments choose from a hierarchy only when they gather; use --gi multires or radiosity");
  if (o.each_light && o.sum != Options::Sum::splat) refuse("multires.each_light=on needs multires.sum=splat");
  if (o.each_light && o.visibility == Options::Visibility::negative)
    refuse("multires.each_light=on has no subsplats for negative lights; use multires.visibility=area_maps or none");
}

StageRole role(const FrameOptions& options) {
  check(options);
  StageRole r{.needs = {product<VirtualLightListGl>()}, .adds = {{reflected_paths(options)}}};
  if (lights_are_a_hierarchy(options)) r.needs.push_back(product<LightPatchTree>());
  const auto visibility = options.of<Options>().visibility;
  if (visibility == Options::Visibility::negative) r.needs.push_back(product<NegativeLights>());
  if (visibility == Options::Visibility::area_maps) r.needs.push_back(product<LightClusters>());
  return r;
}

/// Luminance of the power of all lamps [W], over the scene's diagonal squared.
float even_irradiance(const Scene& scene, float diagonal_m) {
  double power = 0.0;
  for (const Light& light : scene.lights) power += power_luminance(light, scene.bounds_min, scene.bounds_max);
  return float(power / (double(diagonal_m) * double(diagonal_m)));
}

class SubsplatsStage : public Stage {
 public:
  explicit SubsplatsStage(const StageContext& context)
      : options_(context.options.of<Options>()),
        reflected_(reflected_paths(context.options)),
        hierarchical_(lights_are_a_hierarchy(context.options)),
        levels_(SubsplatLevels::of(context.options.size, options_.cells, options_.finest)),
        mipmaps_(levels_, context.options.of<Discontinuity>()),
        buffer_(levels_),
        gather_(options_.form, options_.threshold),
        splat_(options_.form),
        upsample_(levels_, context.options.of<UpsampleOptions>()) {
    if (options_.sum == Options::Sum::gather) return;
    using R = SubsplatRefinement;
    refinement_.emplace(levels_, options_.refine == Options::Refine::geometry ? R::By::geometry : R::By::compute,
                        options_.each_light ? R::For::each_light : R::For::all_lights, options_.form,
                        options_.shine && shines(context.scene));
  }

  void run(FrameData& frame, gl::PassTimer& timer) override {
    const SubsplatVisibility visibility{
        options_.visibility == Options::Visibility::area_maps ? &frame.get<LightClusters>() : nullptr,
        options_.visibility == Options::Visibility::negative ? &frame.get<NegativeLights>() : nullptr};
    const SubsplatReceivers receivers =
        options_.shine ? SubsplatReceivers(frame.gbuffer, frame.camera) : SubsplatReceivers(frame.gbuffer);
    mipmaps_.run(frame.gbuffer, frame.camera, frame.scene_diagonal_m, timer);
    if (!hierarchical_) {
      const VirtualAreaLights* clusters = visibility.clusters != nullptr ? &visibility.clusters->area_lights : nullptr;
      cache_.run(frame.get<VirtualLightListGl>(), clusters, timer);
    }
    buffer_.clear();
    if (refinement_) {
      splat(frame, receivers, visibility, timer);
    } else {
      buffer_.mark(frame.gbuffer, mipmaps_, timer);
      if (hierarchical_) {
        gather_.run(receivers, buffer_, frame.get<LightPatchTree>(), visibility, timer);
      } else {
        gather_.run(receivers, buffer_, cache_, visibility, timer);
      }
    }
    upsample_.run(frame.gbuffer, frame.camera, buffer_.irradiance(), timer);
    frame.layers.push_back({&upsample_.radiance(), reflected_});
  }
  void report(FrameReport& report) const override {
    const size_t fragments = refinement_ ? refinement_->count() : buffer_.fragments();
    report.add("fragments", double(fragments), fmt::format("{} fragments of subsplats", fragments));
    report.memory_bytes += mipmaps_.bytes() + buffer_.bytes() + cache_.bytes() + upsample_.bytes() +
                           (refinement_ ? refinement_->bytes() : 0);
  }
  void list_textures(std::vector<NamedTexture>& list) const override {
    mipmaps_.list_textures(list);
    list_texture(list, StencilGather::name, "irradiance", buffer_.irradiance());
    list_texture(list, Upsample::name, "", upsample_.radiance());
  }

 private:
  void splat(FrameData& frame, const SubsplatReceivers& receivers, const SubsplatVisibility& visibility,
             gl::PassTimer& timer) {
    refinement_->begin_frame();
    if (options_.each_light) {
      const float most_difference = options_.difference * even_irradiance(frame.scene, frame.scene_diagonal_m);
      splat_.run_each(receivers, mipmaps_, buffer_, cache_, *refinement_, most_difference, visibility.clusters, timer);
    } else {
      refinement_->run(receivers, mipmaps_, timer);
      splat_.run(receivers, buffer_, cache_, *refinement_, visibility, timer);
    }
  }

  Options options_;
  LightPaths reflected_;
  bool hierarchical_;
  SubsplatLevels levels_;
  DiscontinuityMipmaps mipmaps_;
  FlattenedBuffer buffer_;
  LightCache cache_;
  StencilGather gather_;
  Splat splat_;
  std::optional<SubsplatRefinement> refinement_;
  Upsample upsample_;
};

}  // namespace

constinit const StageType SUBSPLAT_GATHER{.name = "gather/subsplats",
                                          .slot = Slot::gather,
                                          .parameters = PARAMETERS,
                                          .role = role,
                                          .make = [](const StageContext& context) -> std::unique_ptr<Stage> {
                                            return std::make_unique<SubsplatsStage>(context);
                                          },
                                          .report_nothing = [](FrameReport& report) { report.add("fragments", 0.0); }};

}  // namespace volgi::screen
