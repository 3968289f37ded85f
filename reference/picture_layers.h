#pragma once
#include <functional>
#include <glm/glm.hpp>
#include <string>

#include "core/camera.h"
#include "core/scene.h"
#include "reference/path_integrator.h"
#include "reference/path_tracer.h"

// Private to the room: what every reference picture has, whatever gathers its light.
namespace volgi {

ReferencePicture empty_picture(glm::ivec2 size, PathTracerOptions::Light light);

/// Position, normal, albedo, id and depth of what the camera sees at one pixel.
void write_first_hit(ReferencePicture& picture, glm::ivec2 pixel, const Scene& scene, const Camera& camera,
                     const CameraRay& ray, const PathVertex& vertex);

/// A picture in tiles of 16 x 16 pixels, fewer at its right and lower edge.
class PictureTiles {
 public:
  explicit PictureTiles(glm::ivec2 size);
  int count() const { return columns_ * rows_; }
  /// Calls `shade(x, y)` once for every pixel of a tile, row by row, until it returns false. @returns what it did last.
  template <class Shade>
  bool for_each_pixel(int tile, Shade shade) const {
    const glm::ivec2 first = SIZE * glm::ivec2(tile % columns_, tile / columns_), end = glm::min(first + SIZE, size_);
    for (int y = first.y; y < end.y; ++y)
      for (int x = first.x; x < end.x; ++x)
        if (!shade(x, y)) return false;
    return true;
  }

 private:
  static constexpr int SIZE = 16;
  glm::ivec2 size_;
  int columns_, rows_;
};

/// Calls `shade(x, y)` once for every pixel, tile by tile on `threads` threads (0: all), with a progress bar `title`.
void for_each_pixel(glm::ivec2 size, int threads, const std::string& title, const std::function<void(int, int)>& shade);

}  // namespace volgi
