#include "reference/path_tracer.h"

#include <algorithm>
#include <array>
#include <cassert>

#include "reference/path_integrator.h"
#include "reference/picture_layers.h"

namespace volgi {
namespace {

using AskedLight = PathTracerOptions::Light;

// Samples of one half of a pixel, summed in double and always in the same order.
struct HalfSum {
  glm::dvec3 direct{0.0};
  glm::dvec3 indirect{0.0};
};

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
        samples_per_half_(std::max(1, (options.samples_per_pixel + 1) / 2)),
        max_bounces_(options.light == AskedLight::direct ? 0 : options.max_bounces.value_or(PathIntegrator::unlimited)),
        picture_(empty_picture(options.size, options.light)) {}

  void trace_pixel(int x, int y) {
    const glm::vec2 corner(x, y);
    const CameraRay ray = camera_ray(camera_, corner + 0.5f, options_.size);
    PathVertex centre;
    const bool hit = integrator_.first_vertex(ray, hash(options_.seed, 0x5eedu), centre);
    if (hit) write_first_hit(picture_, {x, y}, scene_, camera_, ray, centre);
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
  int samples_per_half_;
  int max_bounces_;
  ReferencePicture picture_;
};

}  // namespace

ReferencePicture path_trace(const Scene& scene, const Camera& camera, const PathTracerOptions& options) {
  assert(options.size.x > 0 && options.size.y > 0 && options.samples_per_pixel > 0);
  PictureTracer tracer(scene, camera, options);
  for_each_pixel(options.size, options.threads, "reference", [&](int x, int y) { tracer.trace_pixel(x, y); });
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
