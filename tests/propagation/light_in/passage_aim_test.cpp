// Rays to passages and those by the cosine that cross them are the same light, asked for in two ways.
#include "propagation/light_in/passage_aim.h"

#include <gtest/gtest.h>

#include "propagation/light_in/cosine_direction_internal.h"

namespace volgi::test {
namespace {

constexpr float kFar = 100.0f;  // cells: behind every passage

/// A gap of 2 x 12 cells across X, and beyond its end one across Z: a bent passage, some of whose rays cross both.
std::vector<PassageFace> bent_passage(int number) {
  std::vector<PassageFace> faces;
  for (int y = 0; y < 12; ++y) {
    for (int k = 0; k < 2; ++k) {
      faces.push_back({{20, y, 20 + k}, 0, 1.0f, number});
      faces.push_back({{21 + k, y, 21}, 2, 1.0f, number});
    }
  }
  return faces;
}

double by_cosine(const PassageAim::From& from, glm::vec3 point, glm::vec3 normal) {
  constexpr int rays = 1 << 18;
  int through = 0;
  for (int n = 0; n < rays; ++n) {
    const glm::vec3 way = cosine_direction(normal, recurrence_in_square(std::uint32_t(n)));
    if (from.crossed(point + kFar * way) > 0) ++through;
  }
  return double(through) / double(rays);
}

double by_aim(const PassageAim::From& from, glm::vec3 point) {
  constexpr int rays = 1 << 12;
  double sum = 0.0;
  for (int n = 0; n < rays; ++n) {
    const auto ray = from.ray(n, rays, std::uint32_t(n));
    const glm::vec3 way = glm::normalize(ray.target - point);
    sum += double(ray.weight) / double(std::max(from.crossed(point + kFar * way), 1));
  }
  return sum / double(rays);
}

TEST(PassageAim, BothWaysToAskComeToTheSame) {
  std::vector<PassageFace> faces = bent_passage(0);
  for (int k = 0; k < 24; ++k) faces.push_back({{16 + k % 4, 2 + k / 4, 30}, 2, 1.0f, 1});  // another one
  const PassageAim aim(faces);
  const glm::vec3 points[] = {{4.3f, 3.7f, 17.2f}, {15.0f, 0.5f, 20.5f}, {17.2f, 8.0f, 12.0f}};
  const glm::vec3 normals[] = {{1.0f, 0.0f, 0.0f}, glm::normalize(glm::vec3(0.3f, 0.9f, 0.2f)), {0.0f, 0.0f, 1.0f}};
  for (int i = 0; i < 3; ++i) {
    const PassageAim::From from(aim, points[i], normals[i]);
    ASSERT_FALSE(from.empty());
    const double cosine = by_cosine(from, points[i], normals[i]);
    EXPECT_GT(cosine, 0.005);
    EXPECT_NEAR(by_aim(from, points[i]) / cosine, 1.0, 0.03) << i;
  }
}

// What is next to a passage sees enough of it; what faces away, nothing.
TEST(PassageAim, LeavesToTheCosineWhatIsNextToIt) {
  const PassageAim aim(bent_passage(0));
  EXPECT_TRUE(PassageAim::From(aim, {18.5f, 6.0f, 21.0f}, {1.0f, 0.0f, 0.0f}).empty());
  EXPECT_TRUE(PassageAim::From(aim, {10.0f, 6.0f, 21.0f}, {-1.0f, 0.0f, 0.0f}).empty());
  EXPECT_TRUE(aim.is_beside({18.5f, 6.0f, 21.0f}));
  EXPECT_FALSE(aim.is_beside({10.0f, 6.0f, 21.0f}));
  EXPECT_TRUE(PassageAim({}).empty());
}

}  // namespace
}  // namespace volgi::test
