#pragma once
#include <optional>

#include "core/camera.h"
#include "core/scene.h"

namespace volgi {

/// A camera for a file that has none and whose surfaces close a place in, as rooms do: with its back near a wall,
/// looking along the longest way. None where no place is closed (nine tenths of all directions meet something), or
/// where what closes it in turns its back on it, as the surface of a body does. Places that a lamp shines on come
/// first, then large ones. Deterministic. Cost: Embree's tree and some 15,000 rays.
std::optional<Camera> room_camera(const Scene& scene);

}  // namespace volgi
