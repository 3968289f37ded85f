#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "core/camera.h"
#include "core/image.h"
#include "core/scene.h"

namespace volgi {

struct PathTracerOptions {
  glm::ivec2 size{512, 512};
  int samples_per_pixel = 256;     // rounded up to an even number: two halves of equal size
  std::optional<int> max_bounces;  // reflections: 0 is direct light only; none: unlimited, with unbiased roulette
  enum class Light { full, direct, indirect } light = Light::full;
  enum class Filter { point, box } filter = Filter::point;  // point: pixel centres, as a rasterizer samples
  std::uint32_t seed = 1;
  int threads = 0;  // 0: all; the picture does not depend on it
};

/// All layers of one reference picture. `color` is the requested light, `half_a` and `half_b` its two
/// independent halves: color = (a + b)/2, and (a - b)/2 is as noisy as color.
struct ReferencePicture {
  PathTracerOptions::Light light = PathTracerOptions::Light::full;
  Image color, direct, half_a, half_b, direct_half_a, direct_half_b;
  Image position, normal, albedo;  // of the first hit at the pixel's centre; position in the file's world frame, normal
                                   // to the camera's side
  std::vector<float> id, depth;    // Mesh::object_id (0: nothing); distance along the view axis [m]
  std::vector<float> lit;          // PathIntegrator::lights_reaching() there; empty where nobody asked
};

/// Path tracing with next-event estimation towards punctual lights, emissive triangles and the sky (multiple importance
/// sampling with the path's own rays for the last two), glTF's reflection on both sides of every triangle, no clamping.
/// Background: the scene's sky, black without one. Cost: samples · pixels · path length rays. Deterministic: the same
/// bytes for any number of threads.
ReferencePicture path_trace(const Scene& scene, const Camera& camera, const PathTracerOptions& options);

/// Layers as channels: R,G,B; direct.RGB; noise.RGB = (half_a - half_b)/2; direct_noise.RGB likewise; position.XYZ;
/// normal.XYZ; albedo.RGB; id; depth; lit, unless empty. Where R,G,B leave out the direct light (Light::indirect) its
/// layer is called left_out.direct instead.
ChannelImage to_channels(const ReferencePicture& picture);

}  // namespace volgi
