#include "reference/picture_layers.h"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

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

PictureTiles::PictureTiles(glm::ivec2 size)
    : size_(size), columns_((size.x + SIZE - 1) / SIZE), rows_((size.y + SIZE - 1) / SIZE) {}

void for_each_pixel(glm::ivec2 size, int threads, const std::string& title,
                    const std::function<void(int, int)>& shade) {
  std::unique_ptr<tbb::global_control> limit;
  if (threads > 0)
    limit = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism, size_t(threads));
  const PictureTiles tiles(size);
  Progress progress(title, static_cast<std::uint64_t>(tiles.count()));
  tbb::task_arena arena(threads > 0 ? threads : tbb::task_arena::automatic);
  arena.execute([&] {
    tbb::parallel_for(0, tiles.count(), [&](int tile) {
      tiles.for_each_pixel(tile, [&](int x, int y) {
        shade(x, y);
        return true;
      });
      progress.advance();
    });
  });
}

}  // namespace volgi
