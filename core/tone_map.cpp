#include "core/image.h"
#include "shaders/shared/tone_map.shared.h"

namespace volgi {

float srgb_encode(float linear) { return shared::srgb_encode(linear); }
float srgb_decode(float encoded) { return shared::srgb_decode(encoded); }
glm::vec3 tone_map(glm::vec3 linear) { return shared::tone_map(linear); }

}  // namespace volgi
