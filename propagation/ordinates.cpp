#include "propagation/ordinates.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <string>
#include <utility>

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

void add_permutations(OrdinateSet& set, glm::vec3 cosines, float octant_share_each) {
  for (glm::ivec3 order : {glm::ivec3(0, 1, 2), {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}) {
    add_direction(set, {cosines[order.x], cosines[order.y], cosines[order.z]}, octant_share_each);
  }
}

/// The octant's triangle, halved so many times along great circles: weights are areas, directions means (Lambert: half
/// the sum over edges of their angle times the normal of their plane).
void add_triangles(OrdinateSet& set, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, int times) {
  if (times > 0) {
    const glm::dvec3 ab = glm::normalize(a + b), bc = glm::normalize(b + c), ca = glm::normalize(c + a);
    add_triangles(set, a, ab, ca, times - 1);
    add_triangles(set, ab, b, bc, times - 1);
    add_triangles(set, ca, bc, c, times - 1);
    add_triangles(set, ab, bc, ca, times - 1);
    return;
  }
  glm::dvec3 mean(0.0);
  for (const auto& [p, q] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)})
    mean += 0.5 * std::acos(glm::dot(p, q)) * glm::normalize(glm::cross(p, q));
  const double area =
      2.0 * std::atan2(glm::dot(a, glm::cross(b, c)), 1.0 + glm::dot(a, b) + glm::dot(b, c) + glm::dot(c, a));
  add_direction(set, glm::vec3(mean), float(area / (0.5 * glm::pi<double>())));
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
      add_permutations(set, glm::vec3(0.2182179f, 0.5773503f, 0.7867958f), 0.0907407f);
      add_direction(set, glm::vec3(1.0f), 0.0925926f);
      break;
    case 128:  // areas and means of the triangles: ordinates_test.cpp
      add_permutations(set, 0.9822383f, 0.1326799f, 0.0503509f);
      add_permutations(set, glm::vec3(0.1415561f, 0.5171574f, 0.8441031f), 0.0537228f);
      add_permutations(set, 0.9223848f, 0.2731357f, 0.0585505f);
      add_permutations(set, 0.2870176f, 0.6773555f, 0.0840497f);
      add_direction(set, glm::vec3(1.0f), 0.0988103f);
      break;
    case 512:
      add_triangles(set, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}, 3);
      break;
    default:
      throw Error(ExitCode::usage,
                  "no set of " + std::to_string(directions) + " directions; there are 8, 24, 48, 80, 128 and 512");
  }
  for (size_t i = 0; i < set.directions.size(); ++i) set.t += 4.0f * set.weights[i] * set.directions[i].x;
  return set;
}

CellTransfer cell_transfer(Ordinates rule, glm::vec3 direction) {
  const glm::dvec3 d(direction);
  glm::dmat3 share;
  glm::dvec3 track;
  if (rule == Ordinates::step) {
    const double s = d.x + d.y + d.z;
    share = glm::dmat3(d / s, d / s, d / s);
    track = glm::dvec3(1.0 / s);
  } else {
    // Light that comes in through the face of axis `in`, uniform over it, has moved on by the length l (in cell edges)
    // with probability (1 - d_b l)(1 - d_c l), l < m, without having met the faces of the two other axes b and c. It
    // leaves through b at the rate d_b (1 - d_c l), and through `in`'s downwind face if m was the way to that.
    const double m = 1.0 / std::max({d.x, d.y, d.z});
    for (int in = 0; in < 3; ++in) {
      const int b = (in + 1) % 3, c = (in + 2) % 3;
      share[in][b] = d[b] * (m - d[c] * m * m / 2.0);
      share[in][c] = d[c] * (m - d[b] * m * m / 2.0);
      share[in][in] = std::max((1.0 - d[b] * m) * (1.0 - d[c] * m), 0.0);
      track[in] = m - (d[b] + d[c]) * m * m / 2.0 + d[b] * d[c] * m * m * m / 3.0;
    }
  }
  return {glm::mat3(share), glm::vec3(track)};
}

glm::vec3 radiance_per_watt(const OrdinateSet& set, size_t i, Ordinates rule, float cell_size_m) {
  // Power P on its way for the length l h through a volume h^3 is a mean of P l h / h^3.
  const float scale = set.t / (glm::pi<float>() * cell_size_m * cell_size_m);
  return scale * cell_transfer(rule, set.directions[i]).track;
}

OrdinateChoice choose_ordinates(glm::ivec3 cells, const SchemeOptions& options) {
  const int longest = std::max({cells.x, cells.y, cells.z});
  // Closed box, albedo 0.7, first bounce exact, RMSE of all indirect light (tests/hardcases/closed_box_test.cpp): step
  // with 24 at 16^3 0.48 %; with 128 at 32^3 0.27 %, at 64^3 0.22 %; characteristic with 48 at 32^3 0.38 %, with 128 at
  // 64^3 0.21 %. No finer grid is worse. Where the volume carries the first bounce too, spread hides rays: in pictures
  // at 32^3 (cornell, room, occluder) step with 128 is the best of all.
  OrdinateChoice choice;
  choice.directions = options.directions.value_or(longest <= 16 ? 24 : 128);
  if (!options.directions && options.ordinates == Ordinates::characteristic) choice.directions = 128;
  choice.rule =
      options.ordinates.value_or(choice.directions < 48 || longest <= 48 ? Ordinates::step : Ordinates::characteristic);
  return choice;
}
std::optional<OrdinateChoice> choose_source_ordinates(glm::ivec3 cells, const SchemeOptions& options) {
  const bool many =
      options.many_for_sources && !options.directions && choose_ordinates(cells, options).directions == 128;
  if (!many) return std::nullopt;
  return OrdinateChoice{512, options.ordinates.value_or(Ordinates::characteristic)};
}
int directions_for_grid(glm::ivec3 cells) { return choose_ordinates(cells, SchemeOptions{}).directions; }

}  // namespace volgi
