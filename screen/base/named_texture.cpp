#include "screen/base/named_texture.h"

#include <fmt/format.h>

#include <utility>

namespace volgi::screen {

void list_texture(std::vector<NamedTexture>& list, std::string_view pass, std::string_view what,
                  const gl::Texture& texture) {
  if (texture.id() == 0) return;
  list.push_back({what.empty() ? std::string(pass) : fmt::format("{} {}", pass, what), &texture});
}

}  // namespace volgi::screen
