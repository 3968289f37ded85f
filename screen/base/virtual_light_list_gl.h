#pragma once
#include <vector>

#include "core/gl/objects.h"
#include "shaders/shared/virtual_light.shared.h"

namespace volgi::screen {

/// Virtual lights on the GPU, as passes take them. Some may have no flux: those stand for samples that met nothing.
struct VirtualLightListGl {
  static constexpr const char* product_name = "virtual lights";
  gl::Buffer buffer;          // shared::VirtualLight, padded_count() of them; zeros behind the last
  std::vector<int> of_light;  // reflected ones, of each punctual light in its order, then of the sky if there is one
  int reflected = 0;          // lights [0, reflected): the sum of of_light
  int emitted = 0;            // lights [reflected, reflected + emitted)
  bool in_the_air = false;    // all of them are VIRTUAL_LIGHT_LATTICE, which send light to both sides
  int count() const { return reflected + emitted; }
};

/// A multiple of VIRTUAL_LIGHTS_PER_BLOCK, at least one, so that uniform blocks can be bound whole.
size_t padded_count(const VirtualLightListGl& list);
/// Waits for the GPU; after a frame, not in one.
std::vector<shared::VirtualLight> download(const VirtualLightListGl& list);

}  // namespace volgi::screen
