#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "core/gl/objects.h"

namespace volgi::screen {

/// A texture of the last frame that somebody may want to look at.
struct NamedTexture {
  std::string name;  // the pass that writes it, then what it is where there are several: "screen/base/gbuffer normals"
  const gl::Texture* texture;
};

/// @param what  of several that the pass writes; empty: the one. Textures that have not been made are left out.
void list_texture(std::vector<NamedTexture>& list, std::string_view pass, std::string_view what,
                  const gl::Texture& texture);

}  // namespace volgi::screen
