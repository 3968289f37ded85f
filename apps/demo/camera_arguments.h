#pragma once
#include <string>

#include "core/camera.h"
#include "core/scene.h"

namespace volgi::demo {

/// "--eye X,Y,Z --target X,Y,Z --yfov DEG", in the file's world frame [m, degrees]: with it `volgi render` makes the
/// same camera of the same scene, to the last bits of its axes; its near and far plane are fitted to the scene's
/// bounds, as with_depth_of() does. Each number has the fewest digits that make the same float. Lost: roll, as these
/// arguments have +Y up; that a camera is orthographic (its yfov_rad is written); a vertical field of view outside of
/// 0.1 to 179 degrees, which `volgi render` refuses. as_arguments_exact() tells.
std::string camera_arguments(const Camera& camera, const Scene& scene);

/// The camera that camera_arguments() makes, to the bit: a picture of it is the command's, cracks between triangles and
/// all. One that they cannot say stays as it is.
Camera camera_of_arguments(const Camera& camera, const Scene& scene);

/// Whether camera_arguments() says all of the camera's view.
bool as_arguments_exact(const Camera& camera);

}  // namespace volgi::demo
