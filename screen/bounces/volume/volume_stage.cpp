#include "screen/bounces/volume/volume_stage.h"

#include <fmt/format.h>

#include "core/error.h"
#include "core/log.h"
#include "screen/bounces/volume/frame_volume.h"
#include "screen/frame/plan.h"
#include "screen/frame/quality.h"
#include "screen/lights/resample/resample_stage.h"
#include "screen/lights/resample/virtual_light_subdivision.h"
#include "screen/sources/sky/sky_stage.h"

namespace volgi::screen {

namespace {

using enum LightPath;

constexpr const char* ORDINATES[] = {"step", "characteristic"};
constexpr const char* VOXELIZATIONS[] = {"sliced", "single_pass"};
constexpr const char* INJECTIONS[] = {"flux", "max"};
constexpr const char* SOLVERS[] = {"plain", "conjugate_gradients"};

/// BounceRules::Solver without its `automatic`, which is what nobody's choice means.
struct SolverChoice {
  std::optional<int> solver;
};
/// Where nobody chooses a number, and the CPU computes.
struct ManyDirections {
  static constexpr int kCount = 512;
  bool on = false;
};
/// grid.shift moves along all axes.
struct GridShift {
  float cells = 0.0f;
};

constexpr Parameter PARAMETERS[] = {
    number<GridShift>(
        {"grid.shift", "cells", "moves the grid on each axis"}, {-1, 1}, [](GridShift& o) -> auto& { return o.cells; }),
    yes_no<VolumeOptions>(
        {"grid.jitter", "",
         "of pictures that are averaged, each has its grid elsewhere by parts of a cell, on the CPU"},
        [](VolumeOptions& o) -> auto& { return o.grid_jitter; }),
    choice<VolumeOptions>(
        {"ordinates.characteristic", "", "ordinates: how power leaves a cell", "by the grid"}, ORDINATES,
        [](VolumeOptions& o) -> auto& { return o.scheme.ordinates; }),
    yes_no<ManyDirections>(
        {"ordinates.many", "", "ordinates: 512 directions where --directions does not say, on the CPU"},
        [](ManyDirections& o) -> auto& { return o.on; }),
    yes_no<VolumeOptions>(
        {"ordinates.sources", "", "ordinates: 512 directions for the order of what sources send, where all have 128"},
        [](VolumeOptions& o) -> auto& { return o.scheme.many_for_sources; }),
    choice<SolverChoice>(
        {"solver.cg", "", "one bounce after another, or conjugate gradients over bounces",
         "conjugate_gradients where the scheme allows it"},
        SOLVERS, [](SolverChoice& o) -> auto& { return o.solver; }),
    number<VolumeOptions>(
        {"sides.rays", "", "that virtual lights send to the volume's sides, on the CPU", "8 a side, 65536 to 524288"},
        {1024, 1 << 28}, [](VolumeOptions& o) -> auto& { return o.side_rays; }),
    number<VolumeOptions>(
        {"sides.gather", "rays",
         "of each side that pixels read: bounces once more between triangles, on the CPU with ordinates, all bounces "
         "and "
         "one rank; 0: none"},
        {0, 1024}, [](VolumeOptions& o) -> auto& { return o.gather_rays; }),
    number<ContactOptions>(
        {"contacts.paths", "",
         "hybrid with sides.gather: of a picture at most, where what is brightly lit is nearer than cells are large; "
         "0: "
         "none"},
        {0, 1 << 26}, [](ContactOptions& o) -> auto& { return o.paths; }),
    yes_no<VolumeOptions>(
        {"solver.warm", "", "starts from the last frame's answer"},
        [](VolumeOptions& o) -> auto& { return o.warm_start; }),
    number<VolumeOptions>(
        {"solver.passes", "passes", "amortised: at most so many over the volume a frame", "until done"}, {1, 10000},
        [](VolumeOptions& o) -> auto& { return o.passes_per_run; }),
    yes_no<VolumeOptions>(
        {"conservative.coarse", "",
         "conservative: carries the end of each order on a grid of half as many cells, on the CPU only",
         "on there, off on the GPU"},
        [](VolumeOptions& o) -> auto& { return o.scheme.coarse_start; }),
    choice<VolumeOptions>(
        {"voxel.method", "", "the GPU's voxelization: along three axes, or in one pass"}, VOXELIZATIONS,
        [](VolumeOptions& o) -> auto& { return o.voxelization.method; }),
    yes_no<VolumeOptions>(
        {"voxel.interleave", "", "the GPU's voxelization slices along one axis a frame, in turn"},
        [](VolumeOptions& o) -> auto& { return o.voxelization.interleave; }),
    choice<VolumeOptions>(
        {"gaitatzes.inject", "",
         "gaitatzes2010: starts from the flux of sides, or from each occupied cell's largest "
         "radiosity, as printed"},
        INJECTIONS, [](VolumeOptions& o) -> auto& { return o.scheme.injection; }),
    yes_no<VolumeOptions>(
        {"gaitatzes.half_albedo", "", "gaitatzes2010: takes 0.5 for every albedo after the first bounce"},
        [](VolumeOptions& o) -> auto& { return o.scheme.constant_albedo; }),
};

VolumeOptions volume_options(const FrameOptions& options) {
  VolumeOptions o = options.of<VolumeOptions>();
  if (options.of<GridShift>().cells != 0.0f) o.grid_shift_cells = glm::vec3(options.of<GridShift>().cells);
  if (const auto solver = options.of<SolverChoice>().solver) o.solver = BounceRules::Solver(1 + *solver);
  o.bounces = options.bounces;
  if (options.light == LightPart::direct && carries_sides(o.scheme.scheme)) o.bounces = 0;
  return o;
}

StageRole role_alone(const FrameOptions& options) {
  const VolumeOptions o = volume_options(options);
  bounce_rules(o, 0.5f);
  // The papers' volumes do not know which of their light is direct.
  const bool mixes = !carries_sides(o.scheme.scheme);
  if (mixes && !asked_paths(options.light, options.bounces).meets(INDIRECT_PATHS))
    return {.active = false, .lacks = LightPaths{emission_direct} | (SKY_PATHS - LightPaths{sky_seen})};
  const LightPaths all = LightPaths::all() - BASE_PATHS;
  // Only directions know what streams in at the rim.
  if (o.scheme.scheme == Scheme::ordinates) return {.adds = {{all}}};
  return {.adds = {{all - SKY_PATHS}}, .lacks = SKY_PATHS - LightPaths{sky_seen}};
}

StageRole role_after_first_bounce(const FrameOptions& options) {
  const VolumeOptions o = volume_options(options);
  if (!carries_sides(o.scheme.scheme))
    throw Error(ExitCode::usage,
                "a first bounce on the screen, as --gi hybrid has it, needs a scheme that carries "
                "orders: --scheme ordinates or conservative");
  bounce_rules(o, 0.5f);
  LightPaths paths{punctual_higher, emission_first, emission_higher, sky_higher};
  StageRole r{
      .needs = {product<VirtualLightListGl>()}, .uses = {product<SmoothGather>()}, .makes = {product<FrameVolume>()}};
  if (!sky_goes_by_lights(options)) {
    r.uses.push_back(product<SkyMaps>());
    paths = paths | LightPaths{sky_first};
  }
  r.adds = {{paths}};
  if (lights_are_subdivided(options)) r.needs.push_back(product<VirtualLightSubdivision>());
  return r;
}

FrameReport::Value rgb(glm::vec3 v) { return std::vector<double>{double(v.x), double(v.y), double(v.z)}; }

void add_figures(const VolumeReport& v, FrameReport& report) {
  const glm::ivec3 g = v.grid;
  const bool there = g.x > 0;
  const auto words = [&](const std::string& text) { return there ? text : std::string(); };
  report.add("grid", std::vector<double>{double(g.x), double(g.y), double(g.z)},
             words(fmt::format("grid {}x{}x{}", g.x, g.y, g.z)));
  report.add("sides", double(v.sides), words(fmt::format("{} sides", v.sides)));
  report.add("orders", double(v.bounces.orders), words(fmt::format("{} orders", v.bounces.orders)));
  report.add("iterations", double(v.bounces.passes), words(fmt::format("{} passes over the volume", v.bounces.passes)));
  report.add("gather.sides", double(v.gather.seen_sides));
  report.add("gather.rays", double(v.gather.rays),
             v.gather.rays == 0 ? std::string() : fmt::format("{} sides gathered by rays", v.gather.seen_sides));
  report.add("gather.iterations", double(v.gather.iterations));
  report.add("contacts.pixels", double(v.contact_pixels));
  report.add("converged", v.bounces.converged);
  report.add("conservative_coarse", v.coarse_start);
  report.add("backend", std::string(v.on_gpu ? "gpu" : "cpu"),
             words(std::string("volume on the ") + (v.on_gpu ? "GPU" : "CPU")));
  report.add("power_W.injected", rgb(v.injected));
  report.add("power_W.sent", rgb(v.bounces.sent));
  report.add("power_W.left", rgb(v.bounces.left));
  report.add("power_W.lost", rgb(v.lost));
}

class VolumeStage : public Stage {
 public:
  VolumeStage(const StageContext& context, VolumeOptions::Source source)
      : scene_(context.scene),
        size_(context.options.size),
        options_(volume_options(context.options)),
        contacts_(context.options.of<ContactOptions>()),
        on_gpu_(runs_on_gpu(context.options.backend)),
        after_first_bounce_(source == VolumeOptions::Source::first_bounce),
        takes_sky_(after_first_bounce_ && !sky_goes_by_lights(context.options)) {
    options_.source = source;
    const bool many = context.options.of<ManyDirections>().on && !on_gpu_;
    if (many && options_.scheme.scheme == Scheme::ordinates && !options_.scheme.directions) {
      options_.scheme.directions = ManyDirections::kCount;
      if (!options_.scheme.ordinates) options_.scheme.ordinates = Ordinates::characteristic;
    }
    make();
    warn_of_mixed_light(context);
  }

  void lights_ready(FrameData& frame, gl::PassTimer& timer) override {
    if (after_first_bounce_)
      volume_->lights_ready(frame.get<VirtualLightListGl>(), frame.find<VirtualLightSubdivision>(), timer);
  }
  void run(FrameData& frame, gl::PassTimer& timer) override {
    frame.lend(*volume_);
    volume_->set_sample(frame.sample);
    if (after_first_bounce_) {
      const FirstBounce first{frame.get<VirtualLightListGl>(), frame.find<VirtualLightSubdivision>(),
                              takes_sky_ ? frame.find<SkyMaps>() : nullptr, frame.sample, frame.find<SmoothGather>()};
      volume_->run(frame.triangles, frame.shadow_maps, frame.gbuffer, frame.camera, &first, timer);
      // What reaches surfaces from emission, or from sky that sides have received, has been reflected before.
      const LightPaths first_paths = takes_sky_ ? LightPaths{emission_first, sky_first} : LightPaths{emission_first};
      const LightPaths later{punctual_higher, emission_higher, sky_higher};
      if (volume_->first_is_apart()) {
        frame.layers.push_back({&volume_->direct(), first_paths});
        frame.layers.push_back({&volume_->indirect(), later});
      } else {
        frame.layers.push_back({&volume_->indirect(), first_paths | later});
      }
      add_contacts(frame, timer);
      return;
    }
    volume_->run(frame.triangles, frame.shadow_maps, frame.gbuffer, frame.camera, nullptr, timer);
    LightPaths reflected{punctual_first, emission_first, punctual_higher, emission_higher};
    LightPaths arrival{emission_direct};
    if (options_.scheme.scheme == Scheme::ordinates) {
      reflected = reflected | LightPaths{sky_first, sky_higher};
      arrival = arrival | LightPaths{sky_direct};
    }
    if (carries_sides(options_.scheme.scheme)) {
      frame.layers.push_back({&volume_->direct(), arrival});
      frame.layers.push_back({&volume_->indirect(), reflected});
    } else {
      frame.layers.push_back({&volume_->indirect(), reflected | LightPaths{emission_direct}});
    }
  }
  void scene_changed() override {
    if (volume_->follow_scene()) return;
    volume_.reset();  // first, so that there are never two
    make();
  }
  void report(FrameReport& report) const override {
    report.of<VolumeReport>() = volume_->report();
    const VolumeReport& volume = report.of<VolumeReport>();
    add_figures(volume, report);
    warn_of_answer(scene_.name, options_, volume.bounces, volume.pocket_cells,
                   size_t(volume.grid.x) * size_t(volume.grid.y) * size_t(volume.grid.z));
    report.memory_bytes += report.of<VolumeReport>().memory_bytes;
  }
  void list_textures(std::vector<NamedTexture>& list) const override { volume_->list_textures(list); }
  std::string announcement() const override {
    return fmt::format("volume: on the {}, about {:.1f} MiB", on_gpu_ ? "GPU" : "CPU",
                       double(volume_bytes_expected(scene_, options_, on_gpu_, size_)) / 1048576.0);
  }

 private:
  void make() {
    volume_ = on_gpu_ ? make_volume_on_gpu(scene_, options_, size_) : make_volume_on_cpu(scene_, options_, size_);
  }
  /// Where the picture shows all of the indirect light, no part of it is near or far alone, and none comes from a sky.
  void add_contacts(const FrameData& frame, gl::PassTimer& timer) {
    const LightPaths there = paths_in(scene_), indirect = INDIRECT_PATHS & there;
    if (contacts_.paths == 0 || there.meets(SKY_PATHS)) return;
    LightPaths covered;
    std::vector<const gl::Texture*> layers;
    for (const std::span<const RadianceLayer> of : {frame.earlier, std::span<const RadianceLayer>(frame.layers)}) {
      for (const RadianceLayer& layer : of) {
        if (!layer.paths.meets(indirect)) continue;
        if (layer.share != LightShare::whole) return;
        layers.push_back(layer.texture);
        covered = covered | layer.paths;
      }
    }
    if (!(indirect - covered).empty()) return;
    volume_->add_contacts({frame.gbuffer, frame.camera, layers, contacts_.paths, frame.sample}, timer);
  }
  void warn_of_mixed_light(const StageContext& context) const {
    if (carries_sides(options_.scheme.scheme) || context.options.light != LightPart::indirect) return;
    if (!paths_in(scene_).contains(emission_direct)) return;
    warn_once(scene_.name +
              ": the papers' schemes cannot tell light straight from emissive surfaces from reflected "
              "light; --light indirect shows both");
  }

  const Scene& scene_;
  glm::ivec2 size_;
  VolumeOptions options_;
  ContactOptions contacts_;
  bool on_gpu_, after_first_bounce_, takes_sky_;
  std::unique_ptr<FrameVolume> volume_;
};

template <VolumeOptions::Source source>
std::unique_ptr<Stage> make_stage(const StageContext& context) {
  return std::make_unique<VolumeStage>(context, source);
}

void suit(const Needs& needs, TypeMap& settings) {
  settings.of<VolumeOptions>().grid_jitter = needs.samples > 1;
  settings.of<VolumeOptions>().scheme.many_for_sources = needs.interpolation <= 1.0;  // all but what is in haste
  settings.of<VolumeOptions>().gather_rays = needs.interpolation <= 1.0 ? FinalGatherCpu::RAYS_OF_SEEN : 0;
  settings.of<ManyDirections>().on = needs.samples > 1;
}

void report_nothing(FrameReport& report) { add_figures(VolumeReport(), report); }

}  // namespace

void prefer_lpv(TypeMap& settings) { settings.of<VolumeOptions>().scheme.scheme = Scheme::lpv2009; }

constinit const StageType VOLUME{.name = "bounces/volume",
                                 .slot = Slot::bounces,
                                 .parameters = PARAMETERS,
                                 .role = role_alone,
                                 .make = make_stage<VolumeOptions::Source::lights>,
                                 .report_nothing = report_nothing,
                                 .suit = suit};

constinit const StageType VOLUME_AFTER_FIRST_BOUNCE{.name = "bounces/volume after the first bounce",
                                                    .slot = Slot::bounces,
                                                    .parameters = PARAMETERS,
                                                    .role = role_after_first_bounce,
                                                    .make = make_stage<VolumeOptions::Source::first_bounce>,
                                                    .report_nothing = report_nothing,
                                                    .suit = suit};

}  // namespace volgi::screen
