#include "reference/progressive_path_tracer.h"

#include <array>
#include <cassert>
#include <cmath>

#include "reference/picture_layers.h"
#include "reference/pixel_tracer.h"

namespace volgi {

struct ProgressivePathTracer::Data {
  struct Pixel {
    std::array<LightSum, 2> sums;  // of the point sets
    CameraRay ray;
    PathVertex centre;
    bool hit = false;
  };

  Data(const Scene& scene, const Camera& as_seen, const PathTracerOptions& as_requested, PointSets from)
      : camera(as_seen), options(as_requested), sets(from), tracer(scene, camera, options) {
    make_pixels();
  }

  void make_pixels() { pixels.resize(static_cast<size_t>(options.size.x) * static_cast<size_t>(options.size.y)); }

  Pixel& pixel(int x, int y) {
    return pixels[static_cast<size_t>(y) * static_cast<size_t>(options.size.x) + static_cast<size_t>(x)];
  }

  void add_samples(int x, int y, int count) {
    Pixel& p = pixel(x, y);
    if (samples == 0) p.sums = {};  // of a picture before
    const bool known = tracer.starts_at_centre();
    if (known && samples == 0) p.hit = tracer.centre({x, y}, p.ray, p.centre);
    const int before = of_set(0, samples), after = of_set(0, samples + count);
    add_to_set(x, y, p, 0, before, after - before);
    add_to_set(x, y, p, 1, samples - before, samples + count - after - (samples - before));
  }

  void add_to_set(int x, int y, Pixel& p, std::uint32_t set, int first, int count) const {
    if (tracer.starts_at_centre() && !p.hit) {
      tracer.add_background(p.ray, count, p.sums[set]);
    } else {
      tracer.add_samples({x, y}, tracer.starts_at_centre() ? &p.centre : nullptr, set, first, count, p.sums[set]);
    }
  }

  /// How many of the first `count` samples are of a point set.
  int of_set(int set, int count) const {
    if (sets == PointSets::one) return set == 0 ? count : 0;
    return (count + 1 - set) / 2;
  }

  Camera camera;
  PathTracerOptions options;
  PointSets sets;
  PixelTracer tracer;
  std::vector<Pixel> pixels;
  int samples = 0;
};

ProgressivePathTracer::ProgressivePathTracer(const Scene& scene, const Camera& camera, const PathTracerOptions& options,
                                             PointSets sets)
    : data_(std::make_unique<Data>(scene, camera, options, sets)) {
  assert(options.size.x > 0 && options.size.y > 0);
}

ProgressivePathTracer::~ProgressivePathTracer() = default;

void ProgressivePathTracer::restart(const Camera& camera, const PathTracerOptions& options) {
  assert(options.size.x > 0 && options.size.y > 0);
  data_->camera = camera;
  data_->options = options;
  data_->tracer.options_changed();
  data_->make_pixels();
  data_->samples = 0;
}

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
  for (size_t i = 0; i < d.pixels.size(); ++i) {
    const auto& sums = d.pixels[i].sums;
    out.pixels[i] =
        glm::vec3((asked_for(sums[0], d.options.light) + asked_for(sums[1], d.options.light)) / double(d.samples));
  }
  return out;
}

Image ProgressivePathTracer::noise() const {
  const Data& d = *data_;
  const double a = d.of_set(0, d.samples), b = d.of_set(1, d.samples);
  if (b == 0.0) return {};
  // Means of a and b samples differ by s²(1/a + 1/b) in the mean, and that of all errs by s²/(a + b); half where a = b.
  const double scale = std::sqrt(a * b) / (a + b);
  Image out(d.options.size.x, d.options.size.y);
  for (size_t i = 0; i < d.pixels.size(); ++i) {
    const auto& sums = d.pixels[i].sums;
    const glm::dvec3 difference = asked_for(sums[0], d.options.light) / a - asked_for(sums[1], d.options.light) / b;
    out.pixels[i] = glm::vec3(scale * difference);
  }
  return out;
}

int ProgressivePathTracer::part_count() const { return PictureTiles(data_->options.size).count(); }

bool ProgressivePathTracer::trace_part(int part, const std::atomic<bool>& cancelled) {
  Data& d = *data_;
  return PictureTiles(d.options.size).for_each_pixel(part, [&](int x, int y) {
    if (cancelled.load(std::memory_order_relaxed)) return false;
    d.add_samples(x, y, 1);
    return true;
  });
}

void ProgressivePathTracer::finish_sample() { ++data_->samples; }

}  // namespace volgi
