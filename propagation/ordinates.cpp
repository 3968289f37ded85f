#include "propagation/ordinates.h"

#include <algorithm>
#include <glm/gtc/constants.hpp>
#include <string>

#include "core/error.h"

namespace volgi {

namespace {

void add_direction(OrdinateSet& set, glm::vec3 direction, float octant_share) {
  set.directions.push_back(glm::normalize(direction));
  set.weights.push_back(octant_share * 0.5f * glm::pi<float>());
}

void add_permutations(OrdinateSet& set, float a, float b, float octant_share_each) {
  for (int axis = 0; axis < 3; ++axis) {
    glm::vec3 d(b);
    d[axis] = a;
    add_direction(set, d, octant_share_each);
  }
}

}  // namespace

OrdinateSet ordinate_set(int directions) {
  OrdinateSet set;
  switch (directions) {
    case 8:
      add_direction(set, glm::vec3(1.0f), 1.0f);
      break;
    case 24:
      add_permutations(set, 0.267f, 0.682f, 1.0f / 3.0f);
      break;
    case 48:
      add_permutations(set, 0.9261808f, 0.2666355f, 0.1761263f);
      add_permutations(set, 0.2666355f, 0.6815076f, 0.1572070f);
      break;
    case 80:
      add_permutations(set, 0.9511897f, 0.2182179f, 0.1209877f);
      for (glm::ivec3 order : {glm::ivec3(0, 1, 2), {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}) {
        const glm::vec3 cosines(0.2182179f, 0.5773503f, 0.7867958f);
        add_direction(set, {cosines[order.x], cosines[order.y], cosines[order.z]}, 0.0907407f);
      }
      add_direction(set, glm::vec3(1.0f), 0.0925926f);
      break;
    default:
      throw Error(ExitCode::usage,
                  "no set of " + std::to_string(directions) + " directions; there are 8, 24, 48 and 80");
  }
  for (size_t i = 0; i < set.directions.size(); ++i) set.t += 4.0f * set.weights[i] * set.directions[i].x;
  return set;
}

int directions_for_grid(glm::ivec3 cells) { return std::max({cells.x, cells.y, cells.z}) <= 16 ? 24 : 48; }

}  // namespace volgi
