#include "screen/base/base_parameters.h"

#include "screen/base/reflective_shadow_map.h"

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

}  // namespace volgi::screen
