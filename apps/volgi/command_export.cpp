#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <cmath>
#include <memory>
#include <optional>
#include <string>

#include "apps/volgi/commands.h"
#include "apps/volgi/light_options.h"
#include "apps/volgi/program_ranks.h"
#include "apps/volgi/reading_options.h"
#include "apps/volgi/scene_options.h"
#include "apps/volgi/volume_options.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "core/log.h"
#include "core/progress.h"
#include "core/sky.h"
#include "propagation/bounce_checkpoint.h"
#include "propagation/light_in/direct_light_cpu.h"
#include "propagation/ordinates.h"
#include "propagation/volume_cpu.h"
#include "volgi_version.h"
#include "voxel/nvdb_file.h"
#include "voxel/vdb_file.h"
#include "voxel/vdb_parts.h"

namespace volgi::app {

namespace {

struct ExportCommand {
  std::filesystem::path scene_path, out;
  double time_s = 0.0;
  VolumeCommandOptions volume;
  LightOptions light;
  ReadingOptions file;
  std::string stage = "radiance", backend = "auto";
  bool quiet = false, parts = false;
  std::filesystem::path checkpoint;  // folder; empty: none
  int checkpoint_every = 1;

  bool has_radiance() const { return stage == "radiance"; }
  int run() const;

 private:
  void write(const openvdb::GridCPtrVec& grids, openvdb::MetaMap metadata) const;
  void write_of_ranks(const Ranks& ranks, const openvdb::GridCPtrVec& grids, openvdb::MetaMap metadata) const;
};

std::string scheme_text(const VolumeOptions& options, const Grid& grid) {
  const std::string name = scheme_name(options.scheme.scheme);
  if (options.scheme.scheme == Scheme::ordinates)
    return fmt::format("{} with {} directions", name, choose_ordinates(grid.cells, options.scheme).directions);
  return fmt::format("{} with spherical harmonics of order {}", name, options.scheme.sh_order);
}

/// The file's grids, with names, units and transforms.
class ExportGrids {
 public:
  explicit ExportGrids(openvdb::math::Transform::Ptr world_from_index) : transform_(std::move(world_from_index)) {}

  void add_cells(const CellVolumes& cells) {
    add(cells.occupancy,
        {"occupancy", "1", "largest share of light that a surface in the cell stops", openvdb::GRID_FOG_VOLUME});
    add(cells.albedo, {"albedo", "1", "diffuse albedo, mean over the surface in the cell, linear RGB"});
    add(cells.normal, {"normal", "1", "mean of the surface's fronts in the cell, unit length or zero",
                       openvdb::GRID_UNKNOWN, openvdb::VEC_COVARIANT_NORMALIZE});
    add(cells.emission, {"emission", "W m^-2", "largest radiosity that the surface in the cell emits, linear RGB"});
  }

  void add_radiance(const RadianceVolume& radiance) {
    add(fluence(radiance), {"fluence", "W m^-2", "radiance over all directions, sqrt(4 pi) sh_00, linear RGB"});
    for (size_t i = 0; i < radiance.sh.size(); ++i) {
      const std::string name = sh_grid_name(int(i));
      add(radiance.sh[i], {name, "W m^-2 sr^-1",
                           "radiance by the direction that light travels, linear RGB: coefficient " + name.substr(3) +
                               " of real orthonormal spherical harmonics"});
    }
  }

  const openvdb::GridCPtrVec& grids() const { return grids_; }

 private:
  void add(const openvdb::GridBase::Ptr& grid, const GridLabel& label) {
    grid->setTransform(transform_->copy());
    label_grid(*grid, label);
    grids_.push_back(grid);
  }

  openvdb::math::Transform::Ptr transform_;
  openvdb::GridCPtrVec grids_;
};

/// How the file came to be. Nothing that changes from run to run.
openvdb::MetaMap file_metadata(const ExportCommand& command, const VolumeOptions& options, const VolumeCpu& computed,
                               const Scene& scene) {
  openvdb::MetaMap metadata;
  const auto text = [&](const char* key, const std::string& value) {
    metadata.insertMeta(key, openvdb::StringMetadata(value));
  };
  const auto number = [&](const char* key, int value) { metadata.insertMeta(key, openvdb::Int32Metadata(value)); };
  const Grid& grid = computed.grid();
  text("software", VOLGI_VERSION);
  text("scene", scene.name);
  metadata.insertMeta("time_s", openvdb::DoubleMetadata(command.time_s));
  text("units", "SI: lengths in m, quantities in each grid's unit; right-handed, +Y up");
  metadata.insertMeta("grid_cells", openvdb::Vec3IMetadata({grid.cells.x, grid.cells.y, grid.cells.z}));
  metadata.insertMeta("cell_size_m", openvdb::DoubleMetadata(double(grid.cell_size_m)));
  text("backend", "cpu");
  text("stage", command.stage);
  if (!command.has_radiance()) return metadata;
  if (streaming_sky(scene, options) != nullptr) text("sky", scene.sky->name());
  text("scheme", scheme_name(options.scheme.scheme));
  if (options.scheme.scheme == Scheme::ordinates)
    number("directions", choose_ordinates(grid.cells, options.scheme).directions);
  number("sh_order", options.scheme.sh_order);
  if (!scene.lights.empty() && !lights_by_rays(scene, options)) text("first_light", "faces");
  text("bounces", options.bounces ? std::to_string(*options.bounces) : "all");
  const BounceReport& report = computed.report();
  number("orders", report.orders);
  number("iterations", report.passes);
  metadata.insertMeta("converged", openvdb::BoolMetadata(report.converged));
  return metadata;
}

void write_any(const std::filesystem::path& out, const openvdb::GridCPtrVec& grids, const openvdb::MetaMap& metadata) {
  if (out.extension() == ".nvdb") {
    write_nvdb(out, grids);
  } else {
    write_vdb(out, grids, metadata);
  }
}

/// A part each, then all of them in one file, unless the parts are what is wanted.
void ExportCommand::write_of_ranks(const Ranks& ranks, const openvdb::GridCPtrVec& grids,
                                   openvdb::MetaMap metadata) const {
  mark_as_part(metadata, ranks.rank(), ranks.count());
  write_vdb(part_path(out, ranks.rank()), grids, metadata);
  ranks.gather({});  // all are there
  if (parts || ranks.rank() > 0) return;
  std::vector<std::filesystem::path> files;
  for (int rank = 0; rank < ranks.count(); ++rank) files.push_back(part_path(out, rank));
  const VdbFile all = merge_parts(files);
  write_any(out, {all.grids.begin(), all.grids.end()}, all.metadata);
  for (const std::filesystem::path& part : files) std::filesystem::remove(part);
}

void ExportCommand::write(const openvdb::GridCPtrVec& grids, openvdb::MetaMap metadata) const {
  if (const Ranks* ranks = program_ranks()) {
    write_of_ranks(*ranks, grids, std::move(metadata));
  } else {
    write_any(out, grids, metadata);
  }
}

int ExportCommand::run() const {
  set_quiet(quiet || !is_first_rank());
  volume.limit_threads();
  VolumeOptions options = volume.volume_options();
  if (out.extension() != ".nvdb" && out.extension() != ".vdb")
    throw Error(ExitCode::usage, out.string() + ": -o needs a name that ends in .vdb, or .nvdb for NanoVDB");
  check_writable(program_ranks() != nullptr ? part_path(out, program_ranks()->rank()) : out);
  Scene scene = load_scene(scene_path, time_s, file.reading);
  light.apply(scene);
  volume.fit_grid(scene, options);
  refuse_on_cpu(options);
  if (scene.sky && has_radiance() && streaming_sky(scene, options) == nullptr)
    warn_once(scene.name + ": only --scheme ordinates carries the sky's light; it is left out");
  VolumeCpu computed(scene, options, program_ranks());

  std::optional<BounceCheckpoint> kept;
  if (!checkpoint.empty() && has_radiance()) {
    if (!carries_sides(options.scheme.scheme))
      throw Error(ExitCode::usage, "--checkpoint: the papers' schemes have no bounces to go on from");
    kept.emplace(checkpoint, checkpoint_every, program_ranks());
    computed.set_checkpoint(&*kept);
  }
  Progress progress("export", has_radiance() ? 5 : 2);
  if (has_radiance()) {
    computed.voxelize();
    progress.advance();
    computed.light_in(direct_light(scene, computed));
    progress.advance();
    computed.propagate();
    progress.advance();
  }
  if (has_radiance() && is_first_rank())
    warn_of_answer(scene.name, options, computed.report(), computed.pocket_cells(), cell_count(computed.grid()));
  ExportGrids grids(world_from_index(computed.grid(), scene.world_origin));
  grids.add_cells(computed.cells());
  if (has_radiance()) grids.add_radiance(computed.radiance());
  progress.advance();
  write(grids.grids(), file_metadata(*this, options, computed, scene));
  progress.advance();

  if (quiet || !is_first_rank()) return int(ExitCode::done);
  const Grid& grid = computed.grid();
  fmt::print("{}: {} x {} x {} cells of {:.6g} m", scene.name, grid.cells.x, grid.cells.y, grid.cells.z,
             grid.cell_size_m);
  const BounceReport& report = computed.report();
  if (has_radiance()) fmt::print(", {}, {} passes", scheme_text(options, grid), report.passes);
  if (report.orders > 0) fmt::print(" in {} orders", report.orders);
  const bool several = parts && program_ranks() != nullptr;
  const std::string files = several ? fmt::format("{} ... {}", part_path(out, 0).string(),
                                                  part_path(out, program_ranks()->count() - 1).string())
                                    : out.string();
  fmt::print("\nwrote {}: {} grids\n", files, grids.grids().size());
  return int(ExitCode::done);
}

struct MergeCommand {
  std::vector<std::filesystem::path> parts;
  std::filesystem::path out;

  int run() const {
    refuse_several_ranks("merge");
    check_writable(out);
    const VdbFile all = merge_parts(parts);
    write_any(out, {all.grids.begin(), all.grids.end()}, all.metadata);
    return int(ExitCode::done);
  }
};

}  // namespace

void add_merge_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<MergeCommand>();
  CLI::App* command = app.add_subcommand("merge", "make one file of what ranks have left with `export --parts`");
  command->add_option("PART", options->parts, "the files of all ranks, in any order")->required()->type_name("FILE...");
  command->add_option("-o,--output", options->out, "file to write, .vdb or .nvdb")->required()->type_name("FILE");
  command->footer("Example: volgi merge out/cornell.*.vdb -o out/cornell.vdb");
  command->callback([options, &exit_code] { exit_code = options->run(); });
}

void add_export_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<ExportCommand>();
  CLI::App* command = app.add_subcommand("export", "write the voxels and the radiance of a scene's volume as OpenVDB");
  command->add_option("SCENE", options->scene_path, scene_help)->required()->type_name("FILE");
  command
      ->add_option("-o,--output", options->out, "OpenVDB file to write, .vdb, or NanoVDB file, .nvdb, without metadata")
      ->required()
      ->type_name("FILE");
  options->volume.add_to(*command);
  options->light.add_to(*command);
  options->file.add_to(*command);
  command
      ->add_option("--stage", options->stage,
                   "voxels: occupancy, albedo, normal, emission; radiance: fluence and spherical harmonics as well")
      ->check(CLI::IsMember({"voxels", "radiance"}))
      ->capture_default_str();
  command->add_option("--backend", options->backend, "where the volume is computed: the CPU")
      ->check(CLI::IsMember({"auto", "cpu"}))
      ->capture_default_str();
  command->add_option("--time", options->time_s, "time of the scene's animations [s]")
      ->check([](const std::string& text) {
        double time = 0.0;
        const bool finite = CLI::detail::lexical_cast(text, time) && std::isfinite(time);
        return finite ? std::string() : fmt::format("'{}' is not a finite number", text);
      })
      ->capture_default_str();
  command
      ->add_option(
          "--checkpoint", options->checkpoint,
          "folder in which the state of the bounces is kept; the same command goes on from it, as any number of "
          "ranks, to the same bytes")
      ->type_name("DIR");
  command->add_option("--checkpoint-every", options->checkpoint_every, "passes over the volume between two states")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  command->add_flag("--parts", options->parts,
                    "of several ranks: leave OUT.RANK.vdb of each, which `volgi merge` makes one file of");
  command->add_flag("--quiet", options->quiet, "print nothing but errors");
  command->footer(
      "Values are floats, in the unit that each grid names; Blender and Houdini open the file, vdb_print -l lists it.\n"
      "Example: volgi export data/cornell.glb -o out/cornell.vdb --grid 32\n"
      "         mpirun -n 4 volgi export data/cornell.glb -o out/cornell.vdb --grid 256");
  command->callback([options, &exit_code] { exit_code = options->run(); });
}

}  // namespace volgi::app
