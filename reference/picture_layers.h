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

/// Calls `shade(x, y)` once for every pixel, tile by tile on `threads` threads (0: all), with a progress bar `title`.
void for_each_pixel(glm::ivec2 size, int threads, const std::string& title, const std::function<void(int, int)>& shade);

}  // namespace volgi
