#include "reference/path_tracer.h"

#include <algorithm>
#include <array>
#include <cassert>

#include "reference/picture_layers.h"
#include "reference/pixel_tracer.h"

namespace volgi {
namespace {

using AskedLight = PathTracerOptions::Light;

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
        tracer_(scene, camera, options),
        samples_per_half_(std::max(1, (options.samples_per_pixel + 1) / 2)),
        picture_(empty_picture(options.size, options.light)) {
    picture_.lit.assign(picture_.color.pixels.size(), 0.0f);
  }

  void trace_pixel(int x, int y) {
    CameraRay ray;
    PathVertex centre;
    const bool hit = tracer_.centre({x, y}, ray, centre);
    if (hit) {
      write_first_hit(picture_, {x, y}, scene_, camera_, ray, centre);
      picture_.lit[size_t(y) * size_t(options_.size.x) + size_t(x)] = float(tracer_.lights_reaching(centre));
    }
    const bool known = tracer_.starts_at_centre();
    std::array<LightSum, 2> halves;
    for (std::uint32_t half = 0; half < 2; ++half) {
      if (known && !hit) {
        tracer_.add_background(ray, samples_per_half_, halves[half]);
      } else {
        tracer_.add_samples({x, y}, known ? &centre : nullptr, half, 0, samples_per_half_, halves[half]);
      }
    }
    write_light(x, y, halves);
  }

  ReferencePicture take() { return std::move(picture_); }

 private:
  void write_light(int x, int y, const std::array<LightSum, 2>& halves) {
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
  PixelTracer tracer_;
  int samples_per_half_;
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
  if (!picture.lit.empty()) out.channels.push_back({"lit", picture.lit});
  return out;
}

}  // namespace volgi
