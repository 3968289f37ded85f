#include "propagation/light_in/passage_aim.h"

#include <algorithm>
#include <glm/gtc/constants.hpp>

#include "core/hash.h"
#include "propagation/light_in/cosine_direction_internal.h"

namespace volgi {
namespace {

constexpr float NEXT_TO_IT = 3.0f;    // cells: from nearer, a ray to a face would bring too much
constexpr float BESIDE = 5.0f;        // cells
constexpr float LEAST_SHARE = 1e-4f;  // of all irradiance: what sees less of a passage does without
constexpr float LEAST_COSINE = 0.2f;  // of its middle: parts may be seen better

glm::vec3 middle_of(const PassageFace& face) {
  glm::vec3 middle = glm::vec3(face.cell) + 0.5f;
  middle[face.axis] += 0.5f;
  return middle;
}

bool box_is_above(glm::vec3 low, glm::vec3 high, glm::vec3 point, glm::vec3 normal) {
  const glm::vec3 highest = glm::mix(low, high, glm::greaterThan(normal, glm::vec3(0.0f)));
  return glm::dot(highest - point, normal) > 0.0f;
}

bool crosses_box(glm::vec3 from, glm::vec3 way, glm::vec3 low, glm::vec3 high) {
  float first = 0.0f, last = 1.0f;
  for (int axis = 0; axis < 3; ++axis) {
    if (way[axis] == 0.0f) {
      if (from[axis] < low[axis] || from[axis] > high[axis]) return false;
      continue;
    }
    const float a = (low[axis] - from[axis]) / way[axis], b = (high[axis] - from[axis]) / way[axis];
    first = std::max(first, std::min(a, b));
    last = std::min(last, std::max(a, b));
  }
  return first <= last + 1e-5f;
}

bool crosses(const PassageFace& face, glm::vec3 from, glm::vec3 way) {
  const float plane = float(face.cell[face.axis] + 1);
  const float t = (plane - from[face.axis]) / way[face.axis];
  if (!(t > 0.0f && t < 1.0f)) return false;
  const glm::vec3 at = from + t * way - glm::vec3(face.cell);
  for (int axis = 0; axis < 3; ++axis) {
    if (axis != face.axis && !(at[axis] >= 0.0f && at[axis] < 1.0f)) return false;
  }
  return true;
}

}  // namespace

PassageAim::PassageAim(std::span<const PassageFace> faces) {
  for (const PassageFace& face : faces) {
    passages_.resize(std::max(passages_.size(), size_t(face.passage) + 1));
    Passage& p = passages_[size_t(face.passage)];
    p.faces.push_back(face);
    glm::vec3 half(0.5f);
    half[face.axis] = 0.0f;
    p.low = glm::min(p.low, middle_of(face) - half);
    p.high = glm::max(p.high, middle_of(face) + half);
  }
}

bool PassageAim::is_beside(glm::vec3 point) const {
  return std::any_of(passages_.begin(), passages_.end(),
                     [&](const Passage& p) { return glm::distance(point, glm::clamp(point, p.low, p.high)) < BESIDE; });
}

PassageAim::From::From(const PassageAim& aim, glm::vec3 point, glm::vec3 normal)
    : aim_(aim), point_(point), normal_(normal) {
  for (int i = 0; i < int(aim.passages_.size()); ++i) {
    const Passage& p = aim.passages_[size_t(i)];
    if (p.faces.empty() || !box_is_above(p.low, p.high, point, normal)) continue;
    if (glm::distance(point, glm::clamp(point, p.low, p.high)) < NEXT_TO_IT) continue;
    const glm::vec3 to_middle = 0.5f * (p.low + p.high) - point;
    const float squared = glm::dot(to_middle, to_middle);
    const float cosine = std::max(glm::dot(to_middle, normal) / std::sqrt(squared), LEAST_COSINE);
    const float share = cosine * float(p.faces.size()) / (glm::pi<float>() * squared);
    if (share < LEAST_SHARE) continue;
    shares_.push_back({i, share});
    sum_ += share;
  }
}

PassageAim::From::Ray PassageAim::From::ray(int n, int of, std::uint32_t seed) const {
  float at = (float(n) + float(hash(seed) >> 8) * 0x1p-24f) / float(of) * sum_;
  size_t k = 0;
  while (k + 1 < shares_.size() && at >= shares_[k].share) at -= shares_[k++].share;
  const Share& chosen = shares_[k];
  const std::vector<PassageFace>& faces = aim_.passages_[size_t(chosen.passage)].faces;
  // Which face by what is left of the choice, so that they are all asked in turn.
  const float along = std::clamp(at / chosen.share, 0.0f, 0.999999f) * float(faces.size());
  const PassageFace& face = faces[std::min(size_t(along), faces.size() - 1)];
  const glm::vec2 uv = recurrence_in_square(hash(seed ^ 0x9e3779b9u));
  glm::vec3 target = middle_of(face);
  target[(face.axis + 1) % 3] += uv.x - 0.5f;
  target[(face.axis + 2) % 3] += uv.y - 0.5f;
  const glm::vec3 to = target - point_;
  const float squared = glm::dot(to, to);
  const float cosines = std::max(glm::dot(to, normal_), 0.0f) * std::abs(to[face.axis]) / squared;
  return {target, cosines / (glm::pi<float>() * squared) * float(faces.size()) * sum_ / chosen.share};
}

int PassageAim::From::crossed(glm::vec3 to) const {
  const glm::vec3 way = to - point_;
  int count = 0;
  for (const Share& share : shares_) {
    const Passage& p = aim_.passages_[size_t(share.passage)];
    if (!crosses_box(point_, way, p.low, p.high)) continue;
    count += int(std::count_if(p.faces.begin(), p.faces.end(),
                               [&](const PassageFace& face) { return crosses(face, point_, way); }));
  }
  return count;
}

}  // namespace volgi
