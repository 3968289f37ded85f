#pragma once
#include <epoxy/gl.h>

namespace volgi::gl {

/// While it lives, textures that are made keep 32-bit floats where they would keep 16 bits (half floats, fixed point),
/// and shaders that are linked write them so: what pictures lose by 16 bits (tests/hardcases/ranges_test.cpp). Normals
/// that shaders pack in one word stay as they are. Frames made before keep what they have.
class WideStorage {
 public:
  WideStorage();
  ~WideStorage();
  WideStorage(const WideStorage&) = delete;
  WideStorage& operator=(const WideStorage&) = delete;
};

bool wide_storage();
/// The format in which a texture of `format` is kept.
GLenum stored_format(GLenum format);

}  // namespace volgi::gl
