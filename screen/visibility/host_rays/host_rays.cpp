#include "screen/visibility/host_rays/host_rays.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>

namespace volgi::screen {

namespace {

// Positions are rasterized: off by up to this part of the scene's longest edge (reference/virtual_light_tracer.cpp).
constexpr float POSITION_ERROR = 1e-5f;
constexpr float LIFT = 2.0f;  // of both ends, in such errors
constexpr float END = 8.0f;   // before the light

}  // namespace

HostRays::HostRays(const Scene& scene) : scene_(scene), embree_(std::make_unique<EmbreeScene>(scene)) {}

void HostRays::scene_moved() { embree_ = std::make_unique<EmbreeScene>(scene_); }

void HostRays::answer(const Asked& asked, const std::vector<shared::VirtualLight>& lights, const gl::Buffer& askers,
                      const gl::Buffer& questions) const {
  if (asked.pixels == 0) return;
  const auto members = size_t((asked.end - asked.first + asked.shares - 1) / asked.shares);
  const std::vector<glm::vec4> from = askers.download<glm::vec4>(2 * asked.pixels);
  std::vector<glm::uvec2> bits = questions.download<glm::uvec2>(members * asked.pixels);
  const glm::vec3 edge = scene_.bounds_max - scene_.bounds_min;
  const float error_m = POSITION_ERROR * std::max({edge.x, edge.y, edge.z});
  const auto is_seen = [&](size_t pixel, const shared::VirtualLight& light) {
    const glm::vec3 start = glm::vec3(from[2 * pixel]) + LIFT * error_m * glm::vec3(from[2 * pixel + 1]);
    const glm::vec3 way = light.position + LIFT * error_m * light.normal - start;
    const float length = glm::length(way);
    return length <= END * error_m || !embree_->occluded(start, way / length, length - END * error_m, 1u);
  };
  tbb::parallel_for(size_t(0), asked.pixels, [&](size_t pixel) {
    for (size_t m = 0; m < members; ++m) {
      glm::uvec2& own = bits[pixel * members + m];
      const int member = asked.first + int(m) * asked.shares;
      for (int word = 0; word < 2; ++word) {
        for (glm::uint left = own[word]; left != 0; left &= left - 1) {
          const int bit = std::countr_zero(left);
          const int light = std::min((32 * word + bit) * asked.per_group + member, int(lights.size()) - 1);
          if (!is_seen(pixel, lights[size_t(light)])) own[word] &= ~(1u << bit);
        }
      }
    }
  });
  questions.upload(bits.data(), bits.size() * sizeof(glm::uvec2));
}

}  // namespace volgi::screen
