#pragma once
#include "core/gl/objects.h"
#include "core/image.h"

namespace volgi::screen {

/// RGB of a texture as a picture: the one place where GL's bottom row becomes the picture's last. Waits for the GPU.
Image image_from_texture(const gl::Texture& texture);

}  // namespace volgi::screen
