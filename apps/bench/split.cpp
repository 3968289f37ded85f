#include "apps/bench/split.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <limits>

#include "apps/bench/repeated_frame.h"
#include "apps/bench/yardstick.h"
#include "core/octahedral.h"
#include "core/surface.h"
#include "core/visibility/embree_scene.h"
#include "reference/virtual_light_tracer.h"
#include "screen/base/image_from_texture.h"
#include "screen/bounces/volume/frame_volume.h"
#include "screen/frame/quality.h"
#include "screen/frame/registry.h"
#include "voxel/side_search.h"

namespace volgi::app {

namespace {

constexpr std::uint32_t kReferenceSeed = 2;
constexpr int kMoreLights = 4, kMoreRays = 16;
constexpr double kBlindRadii = 4.0;  // some twice as far as lights are from each other
constexpr int kReadOutRays = 256;    // of each pixel: noise of 1 / 16 of how much a room's light varies over directions

PathTracerOptions tracer_options(const SplitOptions& options, std::optional<int> bounces) {
  PathTracerOptions o;
  o.size = glm::ivec2(options.size);
  o.samples_per_pixel = options.reference_spp;
  o.light = PathTracerOptions::Light::indirect;
  o.seed = kReferenceSeed;
  if (bounces) o.max_bounces = *bounces;
  return o;
}

screen::FrameOptions usual_options(const Scene& scene, int size) {
  screen::FrameOptions o;
  screen::apply_recipe("hybrid", o);
  o.light = screen::LightPart::indirect;
  o.size = glm::ivec2(size);
  screen::apply_needs(screen::needs_of(screen::Quality::standard, 0, scene_facts(scene)), {}, o);
  return o;
}

Image sum_of(const Image& a, const Image& b, float of_b = 1.0f) {
  Image sum = a;
  for (size_t i = 0; i < sum.pixels.size(); ++i) sum.pixels[i] += of_b * b.pixels[i];
  return sum;
}

/// Later bounces at pixels by rays to what the volume's sides send, in place of the cells around each pixel.
class RayReadOut {
 public:
  RayReadOut(const Scene& scene, const screen::FrameVolume& volume)
      : embree_(scene), voxels_(download(volume.voxels())) {
    const size_t count = voxels_.side_count();
    const auto values = [&](const gl::Buffer* b) {
      return b != nullptr && count > 0 ? b->download<glm::vec4>(count) : std::vector<glm::vec4>(count, glm::vec4(0.0f));
    };
    const auto sent = volume.light_in();
    const std::vector<glm::vec4> punctual = values(sent.punctual), emitted = values(sent.emitted),
                                 direct = values(volume.direct_irradiance()),
                                 indirect = values(volume.indirect_irradiance());
    const float h = voxels_.grid().cell_size_m;
    for (size_t i = 0; i < count; ++i) {
      const shared::Side& side = voxels_.sides()[i];
      const float area = std::max(side.area_m2, LEAST_SIDE_AREA * h * h);
      radiosity_.push_back(glm::vec3(punctual[i] + emitted[i]) / area +
                           side.albedo * glm::vec3(direct[i] + indirect[i]));
    }
  }

  /// [W m^-2 sr^-1]
  Image picture(const screen::GBuffer& gbuffer) const {
    const std::vector<float> positions = gbuffer.position().download(4), normals = gbuffer.normals().download(4),
                             albedos = gbuffer.albedo().download(4);
    Image image(gbuffer.size().x, gbuffer.size().y);
    tbb::parallel_for(0, image.height, [&](int row) {
      for (int x = 0; x < image.width; ++x) {
        const size_t i = 4 * (size_t(row) * size_t(image.width) + size_t(x));
        if (positions[i + 3] == 0.0f) continue;
        const glm::vec3 normal = octahedral_decode(glm::vec2(normals[i + 2], normals[i + 3]));
        const glm::vec3 irradiance =
            irradiance_at({positions[i], positions[i + 1], positions[i + 2]}, normal, std::uint32_t(i / 4));
        image.at(x, image.height - 1 - row) =
            glm::vec3(albedos[i], albedos[i + 1], albedos[i + 2]) * irradiance * glm::one_over_pi<float>();
      }
    });
    return image;
  }

 private:
  /// Mean radiosity of what rays by the cosine meet.
  glm::vec3 irradiance_at(glm::vec3 position, glm::vec3 normal, std::uint32_t pixel) const {
    const glm::vec3 other = std::abs(normal.x) < 0.7f ? glm::vec3(1.0f, 0.0f, 0.0f) : glm::vec3(0.0f, 1.0f, 0.0f);
    const glm::vec3 right = glm::normalize(glm::cross(normal, other)), up = glm::cross(normal, right);
    glm::vec3 sum(0.0f);
    for (std::uint32_t k = 0; k < kReadOutRays; ++k) {
      // An additive recurrence (Roberts 2018), elsewhere for each pixel.
      const std::uint32_t n = k + 7919u * pixel;
      const float u = float(3242174889u * n >> 8) * 0x1p-24f, v = float(2447445414u * n >> 8) * 0x1p-24f;
      const float radius = std::sqrt(u), angle = glm::two_pi<float>() * v;
      const glm::vec3 way =
          glm::normalize(radius * (std::cos(angle) * right + std::sin(angle) * up) + std::sqrt(1.0f - u) * normal);
      sum += radiosity_met(position, way, n);
    }
    return sum / float(kReadOutRays);
  }
  glm::vec3 radiosity_met(glm::vec3 position, glm::vec3 way, std::uint32_t seed) const {
    RayHit hit;
    if (!embree_.intersect(position, way, std::numeric_limits<float>::infinity(), seed, hit)) return glm::vec3(0.0f);
    const Scene& scene = embree_.scene();
    const SurfacePoint at = surface_point(scene, scene.meshes[hit.mesh], hit.triangle, hit.u, hit.v);
    const bool front = glm::dot(at.geometric_normal, way) < 0.0f;
    const SidesOfPoint sides =
        sides_of_point(voxels_, at.position, front ? at.geometric_normal : -at.geometric_normal, -1);
    glm::vec3 sum(0.0f);
    for (int axis = 0; axis < 3; ++axis) {
      if (sides.weights[axis] > 0.0f) sum += sides.weights[axis] * radiosity_[size_t(sides.sides[axis])];
    }
    return sum;
  }

  EmbreeScene embree_;
  VoxelGrid voxels_;
  std::vector<glm::vec3> radiosity_;
};

/// One scene's pictures, and what is put together of them.
class Split {
 public:
  Split(const Scene& scene, const gl::Context& context, const SplitOptions& options)
      : scene_(scene),
        context_(context),
        size_(options.size),
        usual_(usual_options(scene, options.size)),
        all_(cached_reference(scene, scene.cameras[0], tracer_options(options, {}), options.cache), scene.name),
        one_(cached_reference(scene, scene.cameras[0], tracer_options(options, 1), options.cache)) {}

  nlohmann::json run() {
    RepeatedFrame usual(scene_, context_, usual_, RepeatedFrame::Timing::whole);
    usual.render();
    whole_ = usual.image();
    first_ = picture([](screen::FrameOptions& o) { o.bounces = 1; });
    later_ = sum_of(whole_, first_, -1.0f);
    add("nothing", "as it is by default", whole_);
    add_halves("the first bounce path traced", "all of its terms",
               [&](const Halves& one, const Halves&, size_t k) { return sum_of(one[k], later_); });
    add_halves("later bounces path traced", "all of theirs", [&](const Halves& one, const Halves& all, size_t k) {
      return sum_of(first_, sum_of(all[k], one[k], -1.0f));
    });
    first_bounce(usual);
    later_bounces(usual);
    return {{"scene", scene_.name},
            {"triangles", scene_.triangle_count()},
            {"size", size_},
            {"device", context_.device_name()},
            {"reference_noise_percent", all_.noise_percent()},
            {"grid", usual_.of<VolumeOptions>().grid_cells},
            {"terms", std::move(terms_)}};
  }

 private:
  using Halves = std::array<Image, 2>;
  static Halves halves_of(const ReferenceFile& reference) {
    return {sum_of(reference.color, *reference.noise), sum_of(reference.color, *reference.noise, -1.0f)};
  }
  /// A picture with a reference's paths in it, which share their noise with the reference that it is measured against:
  /// of the two independent halves, the mean product of what each errs by has no noise left.
  /// @param make  (halves of one bounce, of all bounces, which half) -> picture.
  template <class Make>
  void add_halves(const char* exact, const std::string& how, const Make& make) {
    const Halves one = halves_of(one_), all = halves_of(all_.reference());
    const Halves tested{make(one, all, 0), make(one, all, 1)};
    const Mask mask = region_mask(Region::noedge, *all_.reference().layers);
    double products = 0.0, reference = 0.0, sum = 0.0, count = 0.0;
    for (size_t i = 0; i < mask.size(); ++i) {
      if (mask[i] == 0) continue;
      const glm::dvec3 a(tested[0].pixels[i] - all[0].pixels[i]), b(tested[1].pixels[i] - all[1].pixels[i]);
      products += glm::dot(a, b);
      reference += glm::dot(glm::dvec3(all_.reference().color.pixels[i]), glm::dvec3(1.0));
      sum += 0.5 * glm::dot(glm::dvec3(tested[0].pixels[i] + tested[1].pixels[i]), glm::dvec3(1.0));
      count += 3.0;
    }
    terms_.push_back({{"exact", exact},
                      {"how", how},
                      {"error_percent", 100.0 * std::sqrt(std::max(products / count, 0.0)) / (reference / count)},
                      {"block_percent", nullptr},
                      {"energy", sum / reference}});
  }
  template <class Change>
  Image picture(const Change& change) const {
    screen::FrameOptions o = usual_;
    change(o);
    RepeatedFrame frame(scene_, context_, o, RepeatedFrame::Timing::whole);
    frame.render();
    return frame.image();
  }
  Image with(const std::string& parameter) const {
    return picture([&](screen::FrameOptions& o) { screen::set_parameter(o.settings, parameter); });
  }
  void add(const char* exact, const std::string& how, const Image& image) {
    const Metrics::Relative m = all_.measure(image);
    terms_.push_back({{"exact", exact},
                      {"how", how},
                      {"error_percent", m.rmse_pct_denoised.value_or(m.rmse_pct)},
                      {"block_percent", m.blk_pct.value_or(0.0)},
                      {"energy", m.ratio}});
  }
  Image gathered(const VirtualLightTracer& tracer, const VirtualLightList& lights, double at_receiver,
                 double at_light) const {
    VirtualLightGatherOptions o;
    o.size = glm::ivec2(size_);
    o.light = PathTracerOptions::Light::indirect;
    o.blind_at_receiver = at_receiver;
    o.blind_at_light = at_light;
    return tracer.gather(scene_.cameras[0], lights, o).color;
  }

  void first_bounce(const RepeatedFrame& usual) {
    const VirtualLightTracer tracer(scene_);
    const VirtualLightList lights = usual.frame().virtual_lights();
    if (std::any_of(lights.lights.begin(), lights.lights.end(),
                    [](const auto& l) { return l.kind == VIRTUAL_LIGHT_REFLECTED; })) {
      add("visibility", "rays to every light", sum_of(gathered(tracer, lights, 0.0, 0.0), later_));
      add("visibility but near the receiver", "four of a light's radii there hide nothing",
          sum_of(gathered(tracer, lights, kBlindRadii, 0.0), later_));
      add("visibility but near the light", "four of a light's radii there hide nothing",
          sum_of(gathered(tracer, lights, 0.0, kBlindRadii), later_));
      screen::FrameOptions more = usual_;
      const screen::Parameter& count = screen::find_parameter("vpl.count");
      count.set(more.settings, std::min(count.most, kMoreLights * count.get(more.settings).value_or(1024.0)));
      RepeatedFrame frame(scene_, context_, more, RepeatedFrame::Timing::whole);
      frame.render();
      add("lights and visibility", fmt::format("{} times the lights, rays to each", kMoreLights),
          sum_of(gathered(tracer, frame.frame().virtual_lights(), 0.0, 0.0), later_));
    }
    add("clusters", "as many as there may be", with("val.count=1024"));
    add("map resolution", "1024 texels for 256", with("val.map=1024"));
    add("interpolation", "every pixel gathered", with("multires.coarsest=1"));
  }

  void later_bounces(const RepeatedFrame& usual) {
    const auto* volume = usual.frame().products().find<screen::FrameVolume>();
    if (volume == nullptr) return;
    const size_t sides = volume->report().sides;
    const size_t rays = std::clamp(8 * sides, size_t(1) << 16, size_t(1) << 19);
    add("side flux", fmt::format("{} times the rays", kMoreRays), with(fmt::format("sides.rays={}", kMoreRays * rays)));
    screen::FrameOptions finer = usual_;
    const int usual_cells = usual_.of<VolumeOptions>().grid_cells;
    const int cells = std::min(2 * usual_cells, VolumeOptions::kMaxGridCells);
    finer.of<VolumeOptions>().grid_cells = cells;
    finer.backend = screen::Backend::cpu;
    RepeatedFrame fine(scene_, context_, finer, RepeatedFrame::Timing::whole);
    fine.render();
    const std::string how = fmt::format("{} for {}", cells, usual_cells);
    add("cells", how, fine.image());
    add_read_out("cells and read-out", how + ", and rays", fine);
    screen::FrameOptions angles = usual_;
    angles.backend = screen::Backend::cpu;
    angles.of<VolumeOptions>().scheme.directions = 512;
    angles.of<VolumeOptions>().scheme.ordinates = Ordinates::characteristic;
    const auto with_angles = [&](screen::FrameOptions& o) { o = angles; };
    add("angles", "512 directions, characteristic", picture(with_angles));
    angles.of<VolumeOptions>().grid_cells = cells;
    add("angles and cells", how + ", and 512 directions", picture(with_angles));
    add_read_out("read-out", "rays from pixels to what sides send", usual);
  }
  void add_read_out(const char* exact, const std::string& how, const RepeatedFrame& frame) {
    const auto* volume = frame.frame().products().find<screen::FrameVolume>();
    if (!volume->sides_on_gpu() || volume->indirect_irradiance() == nullptr) return;
    const Image read = screen::image_from_texture(volume->indirect());
    const Image by_rays = RayReadOut(scene_, *volume).picture(frame.frame().gbuffer());
    add(exact, how, sum_of(sum_of(frame.image(), read, -1.0f), by_rays));
  }

  const Scene& scene_;
  const gl::Context& context_;
  int size_;
  screen::FrameOptions usual_;
  Yardstick all_;
  ReferenceFile one_;  // bounce
  Image whole_, first_, later_;
  nlohmann::json terms_ = nlohmann::json::array();
};

}  // namespace

nlohmann::json bench_split(const Scene& scene, const gl::Context& context, const SplitOptions& options) {
  return Split(scene, context, options).run();
}

std::string split_table(const nlohmann::json& r) {
  std::string text = fmt::format("{} ({} triangles), {} x {}, grid {}, {}; reference's noise {:.2f} %\n",
                                 r["scene"].get<std::string>(), r["triangles"].get<size_t>(), r["size"].get<int>(),
                                 r["size"].get<int>(), r["grid"].get<int>(), r["device"].get<std::string>(),
                                 r["reference_noise_percent"].get<double>());
  text += fmt::format("  {:<34} {:>8} {:>7} {:>8}\n", "exact", "error %", "blk %", "energy");
  for (const auto& t : r["terms"]) {
    const std::string blocks =
        t["block_percent"].is_null() ? "-" : fmt::format("{:.2f}", t["block_percent"].get<double>());
    text +=
        fmt::format("  {:<34} {:8.2f} {:>7} {:8.3f}  {}\n", t["exact"].get<std::string>(),
                    t["error_percent"].get<double>(), blocks, t["energy"].get<double>(), t["how"].get<std::string>());
  }
  return text;
}

}  // namespace volgi::app
