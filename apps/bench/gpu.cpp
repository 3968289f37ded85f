#include "apps/bench/gpu.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <map>

#include "apps/bench/budget.h"
#include "apps/bench/repeated_frame.h"
#include "apps/bench/yardstick.h"
#include "core/gl/limits.h"
#include "core/gl/scene_buffers.h"
#include "propagation/transport_ordinates_gl.h"
#include "screen/bounces/volume/frame_volume.h"
#include "screen/frame/registry.h"
#include "screen/visibility/area_maps/virtual_area_lights.h"
#include "voxel/sliced_voxelization.h"

namespace volgi::app {

namespace {

using Json = nlohmann::json;

struct Bench {
  const gl::Context& context;
  const GpuBenchOptions& options;
  Budget& budget;

  /// The frame as often as the budget allows. @return frames measured.
  int measure(const Scene& scene, RepeatedFrame& picture, double work) const {
    picture.render();  // cold
    const double cold_s = 1e-3 * picture.frame_ms();
    picture.forget_warm_up();
    const int frames = budget.frames(cold_s, options.frames);
    if (frames > 1) {
      picture.render();
      picture.forget_warm_up();
    }
    for (int f = 0; f < frames; ++f) picture.render();
    budget.took(scene.name, 1e-3 * picture.frame_ms(), work);
    return frames;
  }
};

screen::FrameOptions on_gpu(const std::string& recipe, glm::ivec2 size) {
  screen::FrameOptions o;
  screen::apply_recipe(recipe, o);
  o.size = size;
  o.backend = screen::Backend::gpu;
  return o;
}

// --- copies ---

/// Copies in a row, so that the time to begin one does not count.
constexpr int kCopies = 8;

double copy_ms(const gl::Context& context, size_t bytes, int frames) {
  const gl::Buffer from(bytes), to(bytes);
  from.fill(1);
  to.clear();
  gl::PassTimer timer(context.software(), true);
  for (int f = 0; f <= frames; ++f) {
    if (f == 1) timer.reset();
    timer.begin_frame();
    {
      const auto scope = timer.scope("copy");
      for (int k = 0; k < kCopies; ++k) {
        const bool forth = k % 2 == 0;
        glCopyNamedBufferSubData(forth ? from.id() : to.id(), forth ? to.id() : from.id(), 0, 0, GLsizeiptr(bytes));
      }
    }
    timer.end_frame();
  }
  return timer.medians().at(0).gpu_ms / kCopies;
}

/// From what caches hold to what they do not, as far as this GPU allows buffers.
Json bench_copies(const gl::Context& context, const GpuBenchOptions& options) {
  const auto most = size_t(gl::limit(GL_MAX_SHADER_STORAGE_BLOCK_SIZE));
  Json rows = Json::array();
  for (const size_t mebibytes : {8, 32, 128, 512}) {
    const size_t bytes = mebibytes << 20;
    if (bytes > most || (context.software() && mebibytes > 128) || (options.quick && mebibytes > 8)) break;
    const double ms = copy_ms(context, bytes, options.frames);
    rows.push_back({{"mebibytes", mebibytes}, {"ms", ms}, {"gb_per_s", 2.0 * double(bytes) / (1e6 * ms)}});
  }
  return rows;
}

double best_gb_per_s(const Json& copies) {
  double best = 0.0;
  for (const Json& row : copies) best = std::max(best, row["gb_per_s"].get<double>());
  return best;
}

// --- time against error ---

struct Setting {
  const char* options;  // of `volgi render`
  const char* recipe;
  int area_lights;  // 0: the default
  int cells;        // 0: the default
  bool quick;
};
constexpr Setting kSettings[] = {{"--gi hybrid", "hybrid", 0, 0, false},
                                 {"--gi hybrid --vals 8", "hybrid", 8, 0, false},
                                 {"--gi hybrid --grid 16", "hybrid", 0, 16, true},
                                 {"--gi volume --scheme ordinates", "volume", 0, 0, false},
                                 {"--gi vpl", "vpl", 0, 0, true}};

screen::FrameOptions frame_options(const Setting& setting, glm::ivec2 size) {
  screen::FrameOptions o = on_gpu(setting.recipe, size);
  o.light = screen::LightPart::indirect;
  if (setting.area_lights > 0) o.of<screen::VirtualAreaLightOptions>().count = setting.area_lights;
  if (setting.cells > 0) o.of<VolumeOptions>().grid_cells = setting.cells;
  return o;
}

void bench_error(const Bench& bench, const Scene& scene, Json& rows) {
  const std::filesystem::path file = bench.options.references / (scene.name + ".exr");
  ReferenceFile reference = read_reference(file, PathTracerOptions::Light::indirect);
  const glm::ivec2 size(reference.color.width, reference.color.height);
  const Yardstick yardstick(std::move(reference), file.string());
  for (const Setting& setting : kSettings) {
    if (bench.options.quick && !setting.quick) continue;
    if (!bench.budget.allows(scene.name, setting.options, 1.0)) continue;
    RepeatedFrame picture(scene, bench.context, frame_options(setting, size));
    const int frames = bench.measure(scene, picture, 1.0);
    const Image image = picture.image();
    rows.push_back({{"scene", scene.name},
                    {"options", setting.options},
                    {"size", {size.x, size.y}},
                    {"reference", file.string()},
                    {"frames", frames},
                    {"frame_ms", picture.frame_ms()},
                    {"error_percent", yardstick.error_percent(image)},
                    {"energy", yardstick.measure(image).ratio}});
  }
}

// --- the volume ---

struct Sweep {
  double ms;
  int dispatches;
};

/// One order of all sides' light through the scene's grid, by itself.
Sweep time_sweep(const gl::Context& context, const Scene& scene, int cells, int frames) {
  const gl::SceneBuffers buffers(scene);
  SlicedVoxelization voxelization(make_grid(scene, cells));
  gl::PassTimer timer(context.software(), true);
  timer.begin_frame();
  voxelization.run(buffers, timer);
  timer.end_frame();
  const VoxelGridGl& voxels = voxelization.voxels();
  const gl::Buffer sent(sizeof(glm::vec4) * size_t(voxels.side_capacity)), received(sent.bytes());
  sent.fill(std::bit_cast<GLuint>(1.0f));
  received.clear();
  OrdinatesTransportGl transport(voxels.grid, SchemeOptions{});
  BounceReport report;
  for (int f = -1; f < frames; ++f) {
    if (f <= 0) timer.reset();
    timer.begin_frame();
    {
      const auto scope = timer.scope("sweep");
      transport.carry(voxels, sent, received, BounceRules{}, report);
    }
    timer.end_frame();
  }
  return {timer.medians().at(0).gpu_ms, transport.dispatches()};
}

double ms_of(RepeatedFrame& picture, const char* folder) {
  double sum = 0.0;
  for (const auto& pass : picture.timer().medians()) {
    if (pass.name.starts_with(folder)) sum += pass.gpu_ms;
  }
  return sum;
}

void bench_volume(const Bench& bench, const Scene& scene, int cells, double copy_gb_per_s, Json& rows) {
  screen::FrameOptions options = on_gpu("volume", glm::ivec2(64));
  options.of<VolumeOptions>().grid_cells = cells;
  const double work = double(cells) * cells * cells;
  if (!bench.budget.allows(scene.name, fmt::format("at {} cells", cells), work)) return;
  RepeatedFrame picture(scene, bench.context, options);
  const int frames = bench.measure(scene, picture, work);
  const screen::VolumeReport report = picture.frame().report().of<screen::VolumeReport>();

  const Sweep sweep = time_sweep(bench.context, scene, cells, frames);
  const Grid grid = make_grid(scene, cells);
  const OrdinateChoice choice = choose_ordinates(grid.cells, SchemeOptions{});
  const size_t bytes = OrdinatesTransportGl::moved_bytes_for(grid, choice, report.sides);
  const double gb_per_s = double(bytes) / (1e6 * sweep.ms);
  rows.push_back({{"scene", scene.name},
                  {"grid", {report.grid.x, report.grid.y, report.grid.z}},
                  {"sides", report.sides},
                  {"directions", choice.directions},
                  {"rule", choice.rule == Ordinates::step ? "step" : "characteristic"},
                  {"frames", frames},
                  {"voxelization_ms", ms_of(picture, "voxel/")},
                  {"propagation_ms", ms_of(picture, "propagation/propagate")},
                  {"passes", report.bounces.passes},
                  {"converged", report.bounces.converged},
                  {"sweep_ms", sweep.ms},
                  {"dispatches", sweep.dispatches},
                  {"sweep_bytes", bytes},
                  {"gb_per_s", gb_per_s},
                  {"share_of_copy", gb_per_s / copy_gb_per_s}});
}

// --- passes ---

void bench_passes(const Bench& bench, const Scene& scene, glm::ivec2 size, Json& rows) {
  const double work = double(size.x) * size.y;
  if (!bench.budget.allows(scene.name, fmt::format("at {} x {}", size.x, size.y), work)) return;
  const screen::FrameOptions options = on_gpu(screen::default_recipe({}).name, size);
  RepeatedFrame picture(scene, bench.context, options);
  const int frames = bench.measure(scene, picture, work);
  Json passes = Json::array();
  for (const auto& pass : picture.timer().medians()) passes.push_back({{"name", pass.name}, {"ms", pass.gpu_ms}});
  rows.push_back({{"scene", scene.name},
                  {"triangles", scene.triangle_count()},
                  {"recipe", options.recipe},
                  {"size", {size.x, size.y}},
                  {"frames", frames},
                  {"frame_ms", picture.frame_ms()},
                  {"all_passes_ms", picture.all_passes_ms()},
                  {"memory_bytes", picture.frame().report().memory_bytes},
                  {"passes", passes}});
}

bool is_gpu_timer(const gl::Context& context) {
  return gl::PassTimer(context.software(), false).kind() == gl::PassTimer::Kind::gpu;
}

Json describe(const gl::Context& context, const GpuBenchOptions& options) {
  return {{"device", context.device_name()}, {"gl_version", context.version()},
          {"software", context.software()},  {"timer", is_gpu_timer(context) ? "gpu" : "wall"},
          {"command", options.command},      {"date", options.date},
          {"machine", options.machine},      {"frames", options.frames},
          {"budget_s", options.budget_s},    {"error", Json::array()},
          {"volume", Json::array()},         {"passes", Json::array()},
          {"skipped", Json::array()}};
}

}  // namespace

Json bench_gpu(const std::function<Scene(const std::string&)>& scene, const gl::Context& context,
               const GpuBenchOptions& options, const std::function<void(const std::string&)>& show) {
  // All of them first: a scene that is not there is found out at once.
  std::map<std::string, Scene> scenes;
  for (const char* name : {"cornell", "room", "atrium"}) {
    if (!options.quick || scenes.empty()) scenes.emplace(name, scene(name));
  }
  Json r = describe(context, options);
  Budget budget(options.budget_s, r["skipped"]);
  const Bench bench{context, options, budget};
  const auto wanted = [&](const char* name) { return scenes.contains(name); };
  show(gpu_heading(r));

  r["copies"] = bench_copies(context, options);
  r["copy_gb_per_s"] = best_gb_per_s(r["copies"]);
  show(gpu_copies_table(r));

  budget.begin_part("error", 0.3);
  for (const char* name : {"cornell", "room"}) {
    if (wanted(name)) bench_error(bench, scenes.at(name), r["error"]);
  }
  show(gpu_error_table(r));

  budget.begin_part("volume", 0.65);
  for (const int cells : options.quick ? std::vector{16} : std::vector{32, 64, 128})
    bench_volume(bench, scenes.at("cornell"), cells, r["copy_gb_per_s"], r["volume"]);
  show(gpu_volume_table(r));

  budget.begin_part("passes", 1.0);
  for (const glm::ivec2 size :
       options.quick ? std::vector{glm::ivec2(64)} : std::vector{glm::ivec2(512), {1920, 1080}}) {
    for (const char* name : {"cornell", "atrium"}) {
      if (wanted(name)) bench_passes(bench, scenes.at(name), size, r["passes"]);
    }
  }
  show(gpu_passes_tables(r));
  show(gpu_skipped_list(r));
  r["elapsed_s"] = budget.elapsed_s();
  return r;
}

}  // namespace volgi::app
