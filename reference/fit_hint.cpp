#include "reference/fit_hint.h"

#include <cmath>
#include <numbers>

namespace volgi {
namespace {

constexpr double kBetter = 0.25;      // of the mean square error
constexpr double kNegligible = 1e-4;  // of the reference's mean square

struct Change {
  std::string_view name;
  bool flip_x, flip_y;
  double factor;
};
constexpr std::array kChanges{
    Change{"flipped vertically", false, true, 1.0}, Change{"flipped horizontally", true, false, 1.0},
    Change{"divided by pi", false, false, 1.0 / std::numbers::pi}, Change{"times pi", false, false, std::numbers::pi}};

class Masked {
 public:
  Masked(const Image& image, const Mask& mask) : image_(image), mask_(mask) {}
  glm::dvec3 at(int x, int y) const {
    const size_t i = static_cast<size_t>(y) * static_cast<size_t>(image_.width) + static_cast<size_t>(x);
    return mask_[i] != 0 ? glm::dvec3(image_.pixels[i]) : glm::dvec3(0.0);
  }

 private:
  const Image& image_;
  const Mask& mask_;
};

double squared_error(const Image& ref, const Image& test, const Mask& mask, const Change& change) {
  const Masked r(ref, mask), t(test, mask);
  double sum = 0;
  for (int y = 0; y < ref.height; ++y)
    for (int x = 0; x < ref.width; ++x) {
      const glm::dvec3 changed = t.at(change.flip_x ? ref.width - 1 - x : x, change.flip_y ? ref.height - 1 - y : y);
      const glm::dvec3 e = changed * change.factor - r.at(x, y);
      sum += glm::dot(e, e);
    }
  return sum;
}

bool finite(const Image& image) {
  for (const glm::vec3& c : image.pixels)
    if (!std::isfinite(c.x) || !std::isfinite(c.y) || !std::isfinite(c.z)) return false;
  return true;
}

}  // namespace

std::string_view fit_hint(const Image& ref, const Image& test, const Mask& compared) {
  if (!finite(test)) return {};
  double ref_sum = 0, ref_squares = 0;
  for (size_t i = 0; i < ref.pixels.size(); ++i) {
    if (compared[i] == 0) continue;
    const glm::dvec3 r(ref.pixels[i]);
    ref_sum += r.x + r.y + r.z;
    ref_squares += glm::dot(r, r);
  }
  const double error = squared_error(ref, test, compared, {"", false, false, 1.0});
  if (!(ref_sum > 0) || !(error > kNegligible * ref_squares)) return {};
  for (const Change& change : kChanges)
    if (squared_error(ref, test, compared, change) < kBetter * error) return change.name;
  return {};
}

}  // namespace volgi
