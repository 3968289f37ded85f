#include "reference/progressive_path_tracer.h"

#include <cassert>

#include "reference/picture_layers.h"
#include "reference/pixel_tracer.h"

namespace volgi {

struct ProgressivePathTracer::Data {
  struct Pixel {
    LightSum sum;
    CameraRay ray;
    PathVertex centre;
    bool hit = false;
  };

  Data(const Scene& scene, const Camera& as_seen, const PathTracerOptions& as_requested)
      : camera(as_seen),
        options(as_requested),
        tracer(scene, camera, options),
        pixels(static_cast<size_t>(options.size.x) * static_cast<size_t>(options.size.y)) {}

  Pixel& pixel(int x, int y) {
    return pixels[static_cast<size_t>(y) * static_cast<size_t>(options.size.x) + static_cast<size_t>(x)];
  }

  void add_samples(int x, int y, int count) {
    Pixel& p = pixel(x, y);
    const bool known = tracer.starts_at_centre();
    if (known && samples == 0) p.hit = tracer.centre({x, y}, p.ray, p.centre);
    if (known && !p.hit) {
      tracer.add_background(p.ray, count, p.sum);
      return;
    }
    tracer.add_samples({x, y}, known ? &p.centre : nullptr, 0, samples, count, p.sum);
  }

  Camera camera;
  PathTracerOptions options;
  PixelTracer tracer;
  std::vector<Pixel> pixels;
  int samples = 0;
};

ProgressivePathTracer::ProgressivePathTracer(const Scene& scene, const Camera& camera, const PathTracerOptions& options)
    : data_(std::make_unique<Data>(scene, camera, options)) {
  assert(options.size.x > 0 && options.size.y > 0);
}

ProgressivePathTracer::~ProgressivePathTracer() = default;

void ProgressivePathTracer::trace(int samples_per_pixel) {
  Data& d = *data_;
  for_each_pixel(d.options.size, d.options.threads, "path tracing",
                 [&](int x, int y) { d.add_samples(x, y, samples_per_pixel); });
  d.samples += samples_per_pixel;
}

int ProgressivePathTracer::samples_per_pixel() const { return data_->samples; }

Image ProgressivePathTracer::image() const {
  const Data& d = *data_;
  Image out(d.options.size.x, d.options.size.y);
  if (d.samples == 0) return out;
  for (size_t i = 0; i < d.pixels.size(); ++i)
    out.pixels[i] = glm::vec3(asked_for(d.pixels[i].sum, d.options.light) / double(d.samples));
  return out;
}

}  // namespace volgi
