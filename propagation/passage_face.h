#pragma once
#include <glm/glm.hpp>

namespace volgi {

/// A free face inside of a passage between two rooms, and what goes through it over what cells let through: a gap of
/// 2.4 cells is two cells wide, or three, as it happens to lie in the grid (light_in/narrow_passages.h).
struct PassageFace {
  glm::ivec3 cell;  // below the face, which is across `axis`
  int axis;
  float factor;     // >= 0; above 1 where cells are narrower than the gap
  int passage = 0;  // that it is of, from 0 on
};

}  // namespace volgi
