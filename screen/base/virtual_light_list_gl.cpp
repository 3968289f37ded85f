#include "screen/base/virtual_light_list_gl.h"

#include <algorithm>

namespace volgi::screen {

size_t padded_count(const VirtualLightListGl& list) {
  return (size_t(std::max(list.count() - 1, 0)) / VIRTUAL_LIGHTS_PER_BLOCK + 1) * VIRTUAL_LIGHTS_PER_BLOCK;
}

std::vector<shared::VirtualLight> download(const VirtualLightListGl& list) {
  return list.buffer.download<shared::VirtualLight>(size_t(list.count()));
}

}  // namespace volgi::screen
