#include "screen/base/base_parameters.h"

#include <cmath>

#include "screen/base/reflective_shadow_map.h"
#include "screen/frame/quality.h"

namespace volgi::screen {

namespace {

using Resolution = ReflectiveShadowMap::Resolution;

constexpr Parameter PARAMETERS[] = {
    number<Resolution>(
        {"shadow.spot", "texels", "on a side of a spot's map"}, {16, 8192},
        [](Resolution& r) -> auto& { return r.spot; }),
    number<Resolution>(
        {"shadow.cube", "texels", "on a side of each of a point light's six maps"}, {16, 8192},
        [](Resolution& r) -> auto& { return r.cube_face; }),
    number<Resolution>(
        {"shadow.sun", "texels", "on a side of a directional light's map"}, {16, 8192},
        [](Resolution& r) -> auto& { return r.sun; }),
};

}  // namespace

std::span<const Parameter> base_parameters() { return PARAMETERS; }

void suit_base(const Needs& needs, TypeMap& settings) {
  const auto scaled = [&](int texels) { return int(std::lround(texels * needs.maps)); };
  const Resolution usual;
  settings.of<Resolution>() = {scaled(usual.spot), scaled(usual.cube_face), scaled(usual.sun)};
}

}  // namespace volgi::screen
