#include "reference/picture_layers.h"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <memory>

#include "core/progress.h"

namespace volgi {

ReferencePicture empty_picture(glm::ivec2 size, PathTracerOptions::Light light) {
  ReferencePicture p;
  p.light = light;
  const Image black(size.x, size.y);
  for (Image* image : {&p.color, &p.direct, &p.half_a, &p.half_b, &p.direct_half_a, &p.direct_half_b, &p.position,
                       &p.normal, &p.albedo})
    *image = black;
  p.id.assign(black.pixels.size(), 0.0f);
  p.depth.assign(black.pixels.size(), 0.0f);
  return p;
}

void write_first_hit(ReferencePicture& picture, glm::ivec2 pixel, const Scene& scene, const Camera& camera,
                     const CameraRay& ray, const PathVertex& vertex) {
  picture.position.at(pixel.x, pixel.y) = glm::vec3(glm::dvec3(vertex.surface.position) + scene.world_origin);
  picture.normal.at(pixel.x, pixel.y) = vertex.shading_normal;
  picture.albedo.at(pixel.x, pixel.y) = vertex.surface.albedo;
  const size_t i =
      static_cast<size_t>(pixel.y) * static_cast<size_t>(picture.color.width) + static_cast<size_t>(pixel.x);
  picture.id[i] = static_cast<float>(scene.meshes[vertex.triangle.mesh].object_id);
  const glm::vec3 view_axis = -glm::normalize(glm::vec3(camera.world_from_camera[2]));
  picture.depth[i] = vertex.distance * glm::dot(ray.direction, view_axis);
}

void for_each_pixel(glm::ivec2 size, int threads, const std::string& title,
                    const std::function<void(int, int)>& shade) {
  constexpr int tile = 16;
  std::unique_ptr<tbb::global_control> limit;
  if (threads > 0)
    limit = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism, size_t(threads));
  const int rows = (size.y + tile - 1) / tile, columns = (size.x + tile - 1) / tile;
  Progress progress(title, static_cast<std::uint64_t>(rows) * static_cast<std::uint64_t>(columns));
  tbb::task_arena arena(threads > 0 ? threads : tbb::task_arena::automatic);
  arena.execute([&] {
    tbb::parallel_for(0, rows * columns, [&](int index) {
      const int x0 = index % columns * tile, y0 = index / columns * tile;
      for (int y = y0; y < std::min(y0 + tile, size.y); ++y)
        for (int x = x0; x < std::min(x0 + tile, size.x); ++x) shade(x, y);
      progress.advance();
    });
  });
}

}  // namespace volgi
