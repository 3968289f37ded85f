#include "reference/path_tracer.h"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <array>
#include <cassert>
#include <cmath>
#include <memory>

#include "core/progress.h"
#include "reference/path_integrator.h"

namespace volgi {
namespace {

using AskedLight = PathTracerOptions::Light;

// Samples of one half of a pixel, summed in double and always in the same order.
struct HalfSum {
  glm::dvec3 direct{0.0};
  glm::dvec3 indirect{0.0};
};

ReferencePicture empty_picture(const PathTracerOptions& options) {
  ReferencePicture p;
  p.light = options.light;
  const Image black(options.size.x, options.size.y);
  for (Image* image : {&p.color, &p.direct, &p.half_a, &p.half_b, &p.direct_half_a, &p.direct_half_b, &p.position,
                       &p.normal, &p.albedo})
    *image = black;
  p.id.assign(black.pixels.size(), 0.0f);
  p.depth.assign(black.pixels.size(), 0.0f);
  return p;
}

glm::dvec3 asked_for(const HalfSum& sum, AskedLight light) {
  if (light == AskedLight::direct) return sum.direct;
  return light == AskedLight::indirect ? sum.indirect : sum.direct + sum.indirect;
}

Image half_difference(const Image& a, const Image& b) {
  Image out = a;
  for (size_t i = 0; i < out.pixels.size(); ++i) out.pixels[i] = 0.5f * (a.pixels[i] - b.pixels[i]);
  return out;
}

class PictureTracer {
 public:
  PictureTracer(const Scene& scene, const Camera& camera, const PathTracerOptions& options)
      : scene_(scene),
        camera_(camera),
        options_(options),
        integrator_(scene),
        view_axis_(-glm::normalize(glm::vec3(camera.world_from_camera[2]))),
        samples_per_half_(std::max(1, (options.samples_per_pixel + 1) / 2)),
        max_bounces_(options.light == AskedLight::direct ? 0 : options.max_bounces.value_or(PathIntegrator::unlimited)),
        picture_(empty_picture(options)) {}

  void trace_pixel(int x, int y) {
    const glm::vec2 corner(x, y);
    const CameraRay ray = camera_ray(camera_, corner + 0.5f, options_.size);
    PathVertex centre;
    const bool hit = integrator_.first_vertex(ray, hash(options_.seed, 0x5eedu), centre);
    if (hit) write_surface(x, y, ray, centre);
    const bool same_first_vertex = options_.filter == PathTracerOptions::Filter::point && !integrator_.has_blending();
    if (same_first_vertex && !hit) return;
    std::array<HalfSum, 2> halves;
    for (std::uint32_t half = 0; half < 2; ++half) {
      const std::uint32_t pixel =
          static_cast<std::uint32_t>(y) * static_cast<std::uint32_t>(options_.size.x) + static_cast<std::uint32_t>(x);
      const std::uint32_t seed = hash(hash(options_.seed, pixel), half);
      for (int i = 0; i < samples_per_half_; ++i)
        add_sample(corner, same_first_vertex ? &centre : nullptr, {seed, static_cast<std::uint32_t>(i)}, halves[half]);
    }
    write_light(x, y, halves);
  }

  ReferencePicture take() { return std::move(picture_); }

 private:
  void add_sample(glm::vec2 corner, const PathVertex* known, PathSampler sampler, HalfSum& sum) const {
    PathVertex vertex;
    if (known == nullptr) {
      const bool box = options_.filter == PathTracerOptions::Filter::box;
      const glm::vec2 position = corner + (box ? sampler.next2() : glm::vec2(0.5f));
      if (!integrator_.first_vertex(camera_ray(camera_, position, options_.size), sampler.next_seed(), vertex)) return;
    }
    const PathRadiance radiance = integrator_.trace(known != nullptr ? *known : vertex, sampler, max_bounces_);
    sum.direct += glm::dvec3(radiance.direct);
    sum.indirect += glm::dvec3(radiance.indirect);
  }

  void write_surface(int x, int y, const CameraRay& ray, const PathVertex& vertex) {
    picture_.position.at(x, y) = glm::vec3(glm::dvec3(vertex.surface.position) + scene_.world_origin);
    picture_.normal.at(x, y) = vertex.shading_normal;
    picture_.albedo.at(x, y) = vertex.surface.albedo;
    const size_t i = static_cast<size_t>(y) * static_cast<size_t>(options_.size.x) + static_cast<size_t>(x);
    picture_.id[i] = static_cast<float>(scene_.meshes[vertex.triangle.mesh].object_id);
    picture_.depth[i] = vertex.distance * glm::dot(ray.direction, view_axis_);
  }

  void write_light(int x, int y, const std::array<HalfSum, 2>& halves) {
    const double scale = 1.0 / samples_per_half_;
    const glm::dvec3 a = asked_for(halves[0], options_.light) * scale, b = asked_for(halves[1], options_.light) * scale;
    const glm::dvec3 direct_a = halves[0].direct * scale, direct_b = halves[1].direct * scale;
    picture_.half_a.at(x, y) = glm::vec3(a);
    picture_.half_b.at(x, y) = glm::vec3(b);
    picture_.color.at(x, y) = glm::vec3(0.5 * (a + b));
    picture_.direct_half_a.at(x, y) = glm::vec3(direct_a);
    picture_.direct_half_b.at(x, y) = glm::vec3(direct_b);
    picture_.direct.at(x, y) = glm::vec3(0.5 * (direct_a + direct_b));
  }

  const Scene& scene_;
  const Camera& camera_;
  const PathTracerOptions& options_;
  PathIntegrator integrator_;
  glm::vec3 view_axis_;
  int samples_per_half_;
  int max_bounces_;
  ReferencePicture picture_;
};

}  // namespace

ReferencePicture path_trace(const Scene& scene, const Camera& camera, const PathTracerOptions& options) {
  assert(options.size.x > 0 && options.size.y > 0 && options.samples_per_pixel > 0);
  constexpr int tile = 16;
  std::unique_ptr<tbb::global_control> limit;
  if (options.threads > 0)
    limit =
        std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism, size_t(options.threads));
  PictureTracer tracer(scene, camera, options);
  const int rows = (options.size.y + tile - 1) / tile, columns = (options.size.x + tile - 1) / tile;
  Progress progress("reference", static_cast<std::uint64_t>(rows) * static_cast<std::uint64_t>(columns));
  tbb::task_arena arena(options.threads > 0 ? options.threads : tbb::task_arena::automatic);
  arena.execute([&] {
    tbb::parallel_for(0, rows * columns, [&](int index) {
      const int x0 = index % columns * tile, y0 = index / columns * tile;
      for (int y = y0; y < std::min(y0 + tile, options.size.y); ++y)
        for (int x = x0; x < std::min(x0 + tile, options.size.x); ++x) tracer.trace_pixel(x, y);
      progress.advance();
    });
  });
  return tracer.take();
}

ChannelImage to_channels(const ReferencePicture& picture) {
  // Noise instead of the halves: the halves are color + noise and color - noise, and where they agree it costs nothing.
  ChannelImage out;
  out.width = picture.color.width;
  out.height = picture.color.height;
  out.add_rgb("", picture.color);
  out.add_rgb(picture.light == AskedLight::indirect ? "left_out.direct." : "direct.", picture.direct);
  out.add_rgb("noise.", half_difference(picture.half_a, picture.half_b));
  out.add_rgb("direct_noise.", half_difference(picture.direct_half_a, picture.direct_half_b));
  out.add_xyz("position.", picture.position);
  out.add_xyz("normal.", picture.normal);
  out.add_rgb("albedo.", picture.albedo);
  out.channels.push_back({"id", picture.id});
  out.channels.push_back({"depth", picture.depth});
  return out;
}

}  // namespace volgi
