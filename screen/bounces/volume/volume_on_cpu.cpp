#include <openvdb/openvdb.h>

#include <cstring>
#include <optional>

#include "core/error.h"
#include "core/gl/readback.h"
#include "core/sample_sequence.h"
#include "propagation/light_in/direct_light_cpu.h"
#include "propagation/light_in/narrow_passages.h"
#include "propagation/light_in/reflected_flux_cpu.h"
#include "propagation/light_in/side_sky_cpu.h"
#include "propagation/light_in/volume_service.h"
#include "propagation/radiance_volume_gl.h"
#include "propagation/volume_cpu.h"
#include "screen/bounces/volume/frame_volume.h"
#include "screen/bounces/volume/gather_seen_sides.h"
#include "screen/bounces/volume/radiance_gather.h"
#include "screen/bounces/volume/volume_gather.h"
#include "voxel/voxel_grid_gl.h"

namespace volgi::screen {

namespace {

/// The stages that come before pixels, each under a timer. @param light  of the volume's sides, as SideFlux.
/// @param embree  of the scene, for gaps between its rooms; null: they are as wide as cells show them.
template <class Light>
void run_stages(VolumeCpu& volume, gl::PassTimer& timer, const EmbreeScene* embree, const Light& light) {
  const auto stage = [&](const char* name, const auto& run) {
    auto scope = timer.scope(name);
    run();
  };
  stage("voxel/voxelize_cpu", [&] { volume.voxelize(); });
  if (embree != nullptr && volume.passages_are_old())
    stage("propagation/narrow_passages", [&] { volume.set_passages(narrow_passages(volume.voxels(), *embree)); });
  stage("propagation/light_in_cpu", [&] { volume.light_in(light(volume.sides())); });
  stage("propagation/propagate_cpu", [&] { volume.propagate(); });
  stage("propagation/side_irradiance_cpu", [&] { volume.irradiate(); });
}

/// The picture's own virtual lights, and their subdivision, on the host: the copy is asked for as soon as they are
/// there, and waited for when all that the GPU does for pixels is under way.
class LightsOnHost {
 public:
  void begin(const VirtualLightListGl& lights, const VirtualLightSubdivision* subdivision) {
    copy(lights.buffer, size_t(lights.count()) * sizeof(shared::VirtualLight), lights_copy_);
    if (subdivision != nullptr)
      copy(subdivision->sublights(), size_t(lights.count()) * SUBLIGHTS_PER_LIGHT * sizeof(shared::SubLight),
           sublights_copy_);
  }
  /// begin() comes first.
  const VirtualLightsForSides& end(const VirtualLightListGl& lights, const VirtualLightSubdivision* subdivision,
                                   int sample) {
    const auto count = size_t(lights.count());
    fetch(lights_copy_, count, host_.lights);
    host_.reflected = lights.reflected;
    host_.sublights.clear();
    host_.sample = sample;
    if (subdivision != nullptr) fetch(sublights_copy_, count * SUBLIGHTS_PER_LIGHT, host_.sublights);
    return host_;
  }
  size_t bytes() const {
    return host_.lights.capacity() * sizeof(shared::VirtualLight) +
           host_.sublights.capacity() * sizeof(shared::SubLight);
  }

 private:
  struct Copy {
    std::unique_ptr<gl::Readback> readback;
    size_t bytes = 0;
  };
  static void copy(const gl::Buffer& from, size_t bytes, Copy& copy) {
    if (bytes == 0) return;
    if (copy.bytes != bytes) copy = {std::make_unique<gl::Readback>(bytes, 1), bytes};
    copy.readback->drop_all();
    copy.readback->push(from);
  }
  template <class T>
  static void fetch(Copy& copy, size_t count, std::vector<T>& into) {
    into.resize(count);
    if (count > 0) copy.readback->pop(into.data());
  }

  VirtualLightsForSides host_;
  Copy lights_copy_, sublights_copy_;
};

/// A volume of values by cell as a texture of `layers` volumes stacked in z.
void upload_cells(const openvdb::Vec3SGrid& from, const openvdb::FloatGrid* fourth, const Grid& grid, int layer,
                  const gl::Texture& into) {
  std::vector<glm::vec4> texels(cell_count(grid), glm::vec4(0.0f));
  for (auto value = from.cbeginValueOn(); value; ++value) {
    const openvdb::Coord c = value.getCoord();
    const glm::ivec3 cell(c.x(), c.y(), c.z());
    if (!shared::cell_inside(grid, cell)) continue;
    const openvdb::Vec3s v = *value;
    const float w = fourth != nullptr ? fourth->tree().getValue(c) : 0.0f;
    texels[size_t(shared::cell_index(grid, cell))] = {v.x(), v.y(), v.z(), w};
  }
  glTextureSubImage3D(into.id(), 0, 0, 0, layer * grid.cells.z, grid.cells.x, grid.cells.y, grid.cells.z, GL_RGBA,
                      GL_FLOAT, texels.data());
}

void upload_radiance(const RadianceVolume& radiance, const RadianceVolumeGl& into) {
  for (size_t k = 0; k < radiance.sh.size(); ++k) upload_cells(*radiance.sh[k], nullptr, into.grid, int(k), into.sh);
}

/// Cells and sides in buffers as large as every OpenGL lets shaders see. Larger grids pixels are read from on the CPU.
bool fit_on_gpu(const Grid& grid, size_t sides) {
  constexpr size_t LEAST = size_t(128) << 20;  // GL_MAX_SHADER_STORAGE_BLOCK_SIZE, at least
  return 8 * cell_count(grid) <= LEAST && sizeof(shared::Side) * sides <= LEAST;
}

size_t with_headroom(size_t bytes) { return bytes + bytes / 5; }

/// FrameVolume::follow_scene.
bool follow(const Scene& scene, const VolumeOptions& options, VolumeCpu& volume) {
  volume.shift_grid(options.grid_shift_cells);
  const Grid grid = make_grid(scene, options.grid_cells, options.grid_shift_cells, options.grid_box);
  if (!same_grid(make_cascade(grid, options.cascade).grids.front(), volume.grid())) return false;
  volume.scene_moved();
  return true;
}

VolumeReport report_of(const VolumeCpu& volume) {
  VolumeReport r;
  r.grid = volume.grid().cells;
  r.sides = volume.sides().count();
  r.coarse_start = volume.has_coarse_part();
  r.bounces = volume.report();
  r.pocket_cells = volume.pocket_cells();
  r.lost = volume.flux().lost;
  for (const auto* flux : {&volume.flux().emitted, &volume.flux().punctual}) {
    for (const glm::vec4& f : *flux) r.injected += glm::vec3(f);
  }
  return r;
}

/// The CPU twin computes, the GPU shows: sides and their irradiance are uploaded (but nested grids' pixels are read on
/// the CPU); after a first bounce on the screen its virtual lights are read back. Where ranks hold the volume together
/// this is the one that leads (VolumeLead), and has of the others' sides those that its pixels read, but no light_in()
/// of them.
class SidesOnCpu : public FrameVolume {
 public:
  SidesOnCpu(const Scene& scene, const VolumeOptions& options, glm::ivec2 size)
      : scene_(scene),
        options_(options),
        lead_(options.ranks != nullptr ? std::optional<VolumeLead>(std::in_place, *options.ranks, options)
                                       : std::nullopt),
        volume_(scene, options, options.ranks),
        gather_(size) {
    look_at_geometry();
  }

  void lights_ready(const VirtualLightListGl& lights, const VirtualLightSubdivision* subdivision,
                    gl::PassTimer& timer) override {
    const auto scope = timer.scope("screen/bounces/volume/copy_lights");
    lights_.begin(lights, subdivision);
  }

  void set_sample(int index) override {
    const glm::dvec3 shift = options_.grid_jitter ? grid_shift(std::uint64_t(index)) : glm::dvec3(0.0);
    shift_ = options_.grid_shift_cells + glm::vec3(shift);
    if (!lead_) volume_.shift_grid(shift_);
  }
  void run(const gl::SceneBuffers& /*buffers*/, const ReflectiveShadowMap& /*maps*/, const GBuffer& gbuffer,
           const Camera& camera, const FirstBounce* first_bounce, gl::PassTimer& timer) override {
    radiance_is_new_ = false;
    if (lead_) {
      lead_->run(shift_);
      volume_.shift_grid(shift_);
    }
    volume_.move_cascade(glm::vec3(camera.world_from_camera[3]));
    run_stages(volume_, timer, rays_for_passages(),
               [&](const VolumeSides& sides) { return light_for(sides, first_bounce); });
    if (lead_) fetch_seen(gbuffer, timer);
    const EmbreeScene* embree = rays_for_passages();
    gathered_ = embree != nullptr ? seen_sides_.run(volume_, *embree, gbuffer, timer) : nullptr;
    if (!sides_on_gpu()) {
      voxels_.grid = volume_.grid();
      const bool fetched = lead_.has_value();
      gather_.run_on_cpu(gbuffer, camera, fetched ? VolumeSides(fetched_.voxels) : volume_.sides(),
                         fetched ? std::span(&fetched_.irradiance, 1) : std::span(volume_.irradiance_of_levels()),
                         first_bounce != nullptr ? first_bounce->smooth : nullptr, timer);
      return;
    }
    {
      auto scope = timer.scope("screen/bounces/volume/upload_volume");
      upload_sides();
    }
    const bool apart = first_bounce == nullptr || first_is_apart();
    gather_.run(gbuffer, camera, {voxels_, direct_, indirect_, apart},
                first_bounce != nullptr ? first_bounce->smooth : nullptr, timer);
  }
  bool first_is_apart() const override { return options_.bounces.has_value(); }
  void add_contacts(const ContactPicture& picture, gl::PassTimer& timer) override {
    if (gathered_ != nullptr && after_first_bounce())
      seen_sides_.run_contacts(volume_, *embree_, picture, gather_.indirect(), timer);
  }
  bool follow_scene() override {
    if (!follow(scene_, options_, volume_)) return false;
    look_at_geometry();
    return true;
  }
  const gl::Texture& direct() const override { return gather_.direct(); }
  const gl::Texture& indirect() const override { return gather_.indirect(); }
  void list_textures(std::vector<NamedTexture>& list) const override { gather_.list_textures(list); }
  const VoxelGridGl& voxels() const override { return voxels_; }
  bool sides_on_gpu() const override {
    return !options_.cascade.nested() &&
           fit_on_gpu(volume_.grid(), lead_ ? totals_.sides : volume_.voxels().side_count());
  }
  const gl::Buffer* direct_irradiance() const override { return sides_on_gpu() ? &direct_ : nullptr; }
  const gl::Buffer* indirect_irradiance() const override { return sides_on_gpu() ? &indirect_ : nullptr; }
  const gl::Buffer* indirect_irradiance_but_last(gl::PassTimer& timer) const override {
    if (!sides_on_gpu() || lead_) return nullptr;
    const auto scope = timer.scope("propagation/side_irradiance_cpu");
    upload_values(volume_.irradiance_but_last().indirect, but_last_);
    return &but_last_;
  }
  SentFlux light_in() const override {
    if (!sides_on_gpu() || lead_) return {};
    const SideFlux& flux = volume_.flux();
    upload_values(flux.punctual, punctual_flux_);
    upload_values(flux.emitted, emitted_flux_);
    return {flux.punctual.empty() ? nullptr : &punctual_flux_, flux.emitted.empty() ? nullptr : &emitted_flux_};
  }
  const RadianceVolumeGl* radiance(gl::PassTimer& timer) const override {
    if (options_.passes_per_run || !sides_on_gpu() || lead_) return nullptr;
    if (radiance_is_new_) return &radiance_;
    const auto scope = timer.scope("screen/bounces/volume/radiance");
    const RadianceVolume radiance = volume_.radiance();
    if (radiance_.sh.id() == 0) radiance_ = RadianceVolumeGl(volume_.grid(), int(radiance.sh.size()));
    upload_radiance(radiance, radiance_);
    radiance_is_new_ = true;
    return &radiance_;
  }

  VolumeReport report() const override {
    VolumeReport r = report_of(volume_);
    if (lead_) {
      r.sides = totals_.sides;
      r.injected = glm::vec3(totals_.injected);
    }
    r.memory_bytes = volume_.bytes() + fetched_.bytes() + lights_.bytes() + voxels_.bytes() + direct_.bytes() +
                     indirect_.bytes() + punctual_flux_.bytes() + emitted_flux_.bytes() + but_last_.bytes() +
                     radiance_.bytes() + gather_.bytes() + seen_sides_.bytes();
    r.gather = seen_sides_.report();
    r.contact_pixels = seen_sides_.contact_pixels();
    return r;
  }

 private:
  bool after_first_bounce() const { return options_.source == VolumeOptions::Source::first_bounce; }
  void look_at_geometry() {
    if (after_first_bounce()) {
      embree_.reset();
      embree_ = std::make_unique<EmbreeScene>(scene_);
      sky_.scene_moved();
    } else {
      direct_light_.emplace(scene_, lights_by_rays(scene_, options_));
    }
  }
  const EmbreeScene* rays_for_passages() const {
    if (options_.scheme.scheme != Scheme::ordinates || lead_ || options_.cascade.nested()) return nullptr;
    return after_first_bounce() ? embree_.get() : direct_light_->embree();
  }
  SideFlux light_for(const VolumeSides& sides, const FirstBounce* first_bounce) {
    if (lead_) return direct_light_->flux(volume_.voxels(), *volume_.ranks());
    if (!after_first_bounce()) return direct_light_->flux(sides);
    const VirtualLightsForSides& lights =
        lights_.end(first_bounce->lights, first_bounce->subdivision, first_bounce->sample);
    const bool apart = first_is_apart();
    std::optional<size_t> rays;
    if (options_.side_rays) rays = size_t(*options_.side_rays);
    SideFlux flux = flux_after_first_bounce(sides, *embree_, lights, apart, rays);
    if (const SkyMaps* sky = first_bounce->sky)
      add_sky(sides, sky_.irradiance(sides, *embree_, sky->parts(), sky->version(), first_bounce->sample), apart, flux);
    return flux;
  }
  const VoxelGrid& sides() const { return lead_ ? fetched_.voxels : volume_.voxels(); }
  const SideIrradiance& irradiance() const {
    if (gathered_ != nullptr) return *gathered_;
    return lead_ ? fetched_.irradiance : volume_.irradiance();
  }
  /// Waits for the G-buffer.
  void fetch_seen(const GBuffer& gbuffer, gl::PassTimer& timer) {
    const auto scope = timer.scope("screen/bounces/volume/fetch_sides");
    totals_ = VolumeLead::totals(volume_);
    const std::vector<float> positions = gbuffer.position().download(4);
    std::vector<glm::vec4> points(positions.size() / 4);
    std::memcpy(points.data(), positions.data(), points.size() * sizeof(glm::vec4));
    fetched_ = lead_->fetch(volume_, blocks_seen(volume_.grid(), points));
  }
  void upload_sides() {
    upload(sides(), voxels_);
    upload_values(irradiance().direct, direct_);
    upload_values(irradiance().indirect, indirect_);
  }
  static void upload_values(const std::vector<glm::vec4>& values, gl::Buffer& buffer) {
    const size_t bytes = values.size() * sizeof(glm::vec4);
    if (buffer.bytes() < bytes || buffer.id() == 0) buffer = gl::Buffer(with_headroom(bytes));
    if (bytes > 0) buffer.upload(values.data(), bytes);
  }

  const Scene& scene_;
  VolumeOptions options_;
  std::optional<VolumeLead> lead_;  // none: there is one rank
  VolumeCpu volume_;
  glm::vec3 shift_{0.0f};
  VolumeLead::Totals totals_;
  VolumeLead::Sides fetched_;
  std::optional<DirectLightCpu> direct_light_;  // of Source::lights
  std::unique_ptr<EmbreeScene> embree_;         // of Source::first_bounce
  SideSkyCpu sky_;
  GatherSeenSides seen_sides_;
  const SideIrradiance* gathered_ = nullptr;  // by it, in the last run
  LightsOnHost lights_;
  VoxelGridGl voxels_;
  gl::Buffer direct_, indirect_;
  VolumeGather gather_;
  // Of the last run, when it is asked for.
  mutable gl::Buffer punctual_flux_, emitted_flux_, but_last_;
  mutable RadianceVolumeGl radiance_;
  mutable bool radiance_is_new_ = false;
};

constexpr size_t kNormalBytes = sizeof(glm::vec4);  // of a cell, on the GPU

/// The papers' schemes: spherical harmonics are uploaded.
class PulseOnCpu : public FrameVolume {
 public:
  PulseOnCpu(const Scene& scene, const VolumeOptions& options, glm::ivec2 size)
      : scene_(scene),
        options_(options),
        volume_(scene, options),
        direct_light_(scene, lights_by_rays(scene, options)),
        radiance_(volume_.grid(), options.scheme.sh_order == 2 ? 9 : 4),
        normal_occupancy_(gl::Texture::make_3d(GL_RGBA32F, volume_.grid().cells)),
        gather_(size, options.scheme.sh_order) {}

  void run(const gl::SceneBuffers& /*buffers*/, const ReflectiveShadowMap& /*maps*/, const GBuffer& gbuffer,
           const Camera& /*camera*/, const FirstBounce* /*first_bounce*/, gl::PassTimer& timer) override {
    run_stages(volume_, timer, nullptr, [&](const VolumeSides& sides) { return direct_light_.flux(sides); });
    {
      auto scope = timer.scope("screen/bounces/volume/upload_volume");
      upload_radiance(volume_.radiance(), radiance_);
      upload_cells(*volume_.cells().normal, volume_.cells().occupancy.get(), volume_.grid(), 0, normal_occupancy_);
      upload(volume_.voxels(), voxels_);
    }
    const bool occupied_only = options_.scheme.scheme == Scheme::gaitatzes2010;
    gather_.run(gbuffer, voxels_, radiance_, occupied_only ? &normal_occupancy_ : nullptr, timer);
  }
  bool follow_scene() override {
    if (!follow(scene_, options_, volume_)) return false;
    direct_light_.scene_moved();
    return true;
  }
  const gl::Texture& direct() const override { return gather_.direct(); }
  const gl::Texture& indirect() const override { return gather_.indirect(); }
  void list_textures(std::vector<NamedTexture>& list) const override { gather_.list_textures(list); }
  const VoxelGridGl& voxels() const override { return voxels_; }
  const RadianceVolumeGl* radiance(gl::PassTimer& /*timer*/) const override { return &radiance_; }

  VolumeReport report() const override {
    VolumeReport r = report_of(volume_);
    r.memory_bytes = volume_.bytes() + voxels_.bytes() + radiance_.bytes() + kNormalBytes * cell_count(volume_.grid()) +
                     gather_.bytes();
    return r;
  }

 private:
  const Scene& scene_;
  VolumeOptions options_;
  VolumeCpu volume_;
  DirectLightCpu direct_light_;
  RadianceVolumeGl radiance_;
  gl::Texture normal_occupancy_;
  VoxelGridGl voxels_;
  RadianceGather gather_;
};

}  // namespace

size_t volume_bytes_on_cpu(const Scene& scene, const VolumeOptions& options, glm::ivec2 size) {
  const Grid grid = make_grid(scene, options.grid_cells, options.grid_shift_cells, options.grid_box);
  if (options.cascade.nested())
    return bytes_expected_cpu(scene, make_cascade(grid, options.cascade), options) + VolumeGather::bytes_for(size);
  const ExpectedSides expected = expected_sides(scene, grid);
  const bool fits = fit_on_gpu(grid, expected.sides);
  const size_t uploaded = sizeof(Grid) + 8 * cell_count(grid) + sizeof(shared::Side) * expected.sides;
  size_t bytes = fits ? uploaded : 0;
  if (options.ranks != nullptr) {
    const Decomposition parts(leaf_blocks(grid), options.ranks->count());
    bytes += bytes_expected_cpu(scene, grid, options, RanksOfVolume{*options.ranks, parts});
  } else {
    bytes += bytes_expected_cpu(scene, grid, options, expected);
  }
  if (gathers_seen_sides(options)) {
    bytes += FinalGatherCpu::bytes_for(grid, expected.sides, options.gather_rays);
    bytes += sizeof(glm::vec4) * size_t(size.x) * size_t(size.y);
  }
  if (carries_sides(options.scheme.scheme) && !fits) return bytes + VolumeGather::bytes_for(size);
  if (carries_sides(options.scheme.scheme))
    return bytes + 2 * with_headroom(sizeof(glm::vec4) * expected.sides) + VolumeGather::bytes_for(size);
  const int coefficients = options.scheme.sh_order == 2 ? 9 : 4;
  return bytes + RadianceVolumeGl::bytes_for(grid, coefficients) + kNormalBytes * cell_count(grid) +
         RadianceGather::bytes_for(size);
}

std::unique_ptr<FrameVolume> make_volume_on_cpu(const Scene& scene, const VolumeOptions& options, glm::ivec2 size) {
  refuse_on_cpu(options);
  const bool first_bounce = options.source == VolumeOptions::Source::first_bounce;
  if (options.ranks != nullptr) {
    if (first_bounce)
      throw Error(ExitCode::usage,
                  "a first bounce on the screen is for one rank; of several, pictures are of the volume alone");
    refuse_of_ranks(options);
    return std::make_unique<SidesOnCpu>(scene, options, size);
  }
  if (first_bounce && options.first_light == VolumeOptions::FirstLight::faces)
    throw Error(ExitCode::usage, "--first-light faces is for --gi volume: a first bounce on the screen has its own");
  if (options.memory_limit) refuse_above_limit(options, volume_bytes_on_cpu(scene, options, size), "CPU");
  if (carries_sides(options.scheme.scheme)) return std::make_unique<SidesOnCpu>(scene, options, size);
  return std::make_unique<PulseOnCpu>(scene, options, size);
}

}  // namespace volgi::screen
