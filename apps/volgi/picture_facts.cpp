#include "apps/volgi/picture_facts.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/log.h"
#include "core/visibility/openness.h"
#include "reference/path_tracer.h"
#include "screen/base/reflective_shadow_map.h"

namespace volgi::app {

namespace {

constexpr int EDGE = 48;     // pixels
constexpr int SAMPLES = 16;  // of a pixel

double mean(const Image& image) {
  double sum = 0.0;
  for (const glm::vec3& p : image.pixels) sum += double(p.x) + double(p.y) + double(p.z);
  return sum / (3.0 * double(std::max<size_t>(1, image.pixels.size())));
}

/// Root mean square of what two halves of the samples differ by, which a picture's error is, over its mean.
double noise(const ReferencePicture& picture) {
  double squares = 0.0;
  for (size_t i = 0; i < picture.half_a.pixels.size(); ++i) {
    const glm::dvec3 d = 0.5 * glm::dvec3(picture.half_a.pixels[i] - picture.half_b.pixels[i]);
    squares += glm::dot(d, d) / 3.0;
  }
  const double light = mean(picture.color);
  return light > 0.0 ? std::sqrt(squares / double(picture.half_a.pixels.size())) / light : 0.0;
}

double texels_of(Light::Type type) {
  const screen::ReflectiveShadowMap::Resolution usual;
  switch (type) {
    case Light::Type::spot:
      return double(usual.spot) * usual.spot;
    case Light::Type::point:
      return 6.0 * usual.cube_face * usual.cube_face;
    case Light::Type::directional:
      break;
  }
  return double(usual.sun) * usual.sun;
}

}  // namespace

screen::PictureFacts picture_facts(const Scene& scene, const Camera& camera, const SceneFacts& facts,
                                   const std::optional<GridBox>& box) {
  const Quiet quiet;
  PathTracerOptions tracer;
  tracer.size = glm::ivec2(EDGE);
  tracer.samples_per_pixel = SAMPLES;
  tracer.light = PathTracerOptions::Light::indirect;
  const ReferencePicture all = path_trace(scene, camera, tracer);
  tracer.max_bounces = 1;
  const ReferencePicture once = path_trace(scene, camera, tracer);
  const double indirect = mean(all.color), direct = mean(all.direct);
  screen::PictureFacts seen;
  seen.scene = facts;
  seen.triangles = double(scene.triangle_count());
  seen.indirect_share = indirect > 0.0 ? indirect / (indirect + direct) : 0.0;
  seen.first_share = indirect > 0.0 ? std::min(1.0, mean(once.color) / indirect) : 0.0;
  seen.noise = noise(all);
  seen.openness = openness(scene, std::array{glm::vec3(camera.world_from_camera[3])});
  seen.cells = double(cell_count(make_grid(scene, facts.cells, glm::vec3(0.0f), box)));
  for (const Light& light : scene.lights) seen.shadow_texels += texels_of(light.type);
  seen.sky = scene.sky != nullptr;
  seen.emits = seen.sky || std::any_of(scene.materials.begin(), scene.materials.end(),
                                       [](const Material& m) { return m.is_emissive(); });
  return seen;
}

}  // namespace volgi::app
