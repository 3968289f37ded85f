// The choice of virtual lights: by weights computed again in double precision, and what it keeps of the candidates.
#include <numeric>
#include <random>
#include <set>

#include "core/halton.h"
#include "core/hilbert.h"
#include "core/luminance.h"
#include "screen/frame/frame.h"
#include "screen/lights/resample/resample_stage.h"
#include "screen/lights/resample/resample_virtual_lights.h"
#include "screen/lights/rsm/virtual_lights.h"
#include "tests/screen/gathered.h"
#include "tests/screen/virtual_light_scenes.h"
#include "tests/support/gl_test.h"

namespace volgi::test {
namespace {

using ResampleVirtualLightsTest = GlTest;
using screen::ResampleVirtualLights;

/// Share of what is chosen that each candidate of one source has (screen/lights/resample/resample_virtual_lights.h).
std::vector<double> probabilities(const std::vector<VirtualLight>& candidates, const Seen& seen) {
  std::vector<double> sent(candidates.size()), flux(candidates.size());
  for (size_t i = 0; i < candidates.size(); ++i) {
    flux[i] = luminance(glm::dvec3(candidates[i].flux));
    for (unsigned k = 1; k <= 256; ++k) {
      const glm::ivec2 at = glm::ivec2(halton(k) * glm::dvec2(seen.size));
      const size_t pixel = size_t(at.x) + size_t(seen.size.x) * size_t(at.y);
      if (seen.position[pixel].w == 0.0f) continue;
      // The shading normal alone counts here.
      const glm::dvec3 w = glm::dvec3(candidates[i].position) - glm::dvec3(seen.position[pixel]);
      const double squared = glm::dot(w, w);
      const double cosines = std::max(0.0, glm::dot(w, seen.normal(pixel))) *
                             std::max(0.0, -glm::dot(w, glm::dvec3(candidates[i].normal))) / squared;
      sent[i] += flux[i] * luminance(glm::dvec3(seen.albedo[pixel])) * cosines /
                 (glm::pi<double>() * squared + double(candidates[i].area_m2));
    }
  }
  const double all_sent = std::accumulate(sent.begin(), sent.end(), 0.0);
  const double all_flux = std::accumulate(flux.begin(), flux.end(), 0.0);
  for (size_t i = 0; i < sent.size(); ++i) {
    const double by_flux = all_flux > 0.0 ? flux[i] / all_flux : 0.0;
    const double share = double(ResampleVirtualLights::kFluxShare);
    sent[i] = all_sent > 0.0 ? (1.0 - share) * sent[i] / all_sent + share * by_flux : by_flux;
  }
  return sent;
}

/// On the walls of a room around the stage, as virtual lights are, in no order.
std::vector<VirtualLight> candidates_of(int count, int source, unsigned seed) {
  std::mt19937 random(seed);
  const auto uniform = [&] { return float(random()) / 4294967296.0f; };
  std::vector<VirtualLight> lights;
  for (int i = 0; i < count; ++i) {
    glm::vec3 at(6.0f * uniform() - 3.0f, 6.0f * uniform() - 3.0f, 6.0f * uniform() - 3.0f);
    const int axis = int(random() % 3u);
    const float side = uniform() < 0.5f ? -1.0f : 1.0f;
    at[axis] = 3.0f * side;
    glm::vec3 normal(0.0f);
    normal[axis] = -side;
    lights.push_back(light_at(at + glm::vec3(0, 1, 0), normal, {uniform(), uniform(), uniform()}, 0.05f * uniform()));
    lights.back().source = source;
  }
  return lights;
}

Seen stage_seen(const gl::Context& context) {
  const Scene scene = stage();
  return {context, scene, stage_camera(scene), {64, 48}};
}

std::vector<VirtualLight> chosen(Seen& seen, const VirtualLightListGl& candidates, int candidates_per_light) {
  ResampleVirtualLights choose(candidates_per_light);
  choose.run(candidates, seen.gbuffer, seen.timer);
  const VirtualLightListGl& list = choose.lights();
  EXPECT_EQ(list.reflected, std::accumulate(list.of_light.begin(), list.of_light.end(), 0));
  EXPECT_EQ(list.buffer.bytes(), padded_count(list) * sizeof(VirtualLight));
  return download(list);
}

// Light k is the candidate at the place (k + 1/2) / count of the summed probabilities, and carries 1 / (count p) of it.
TEST_F(ResampleVirtualLightsTest, EqualStepsThroughTheSummedWeights) {
  Seen seen = stage_seen(context());
  const auto candidates = candidates_of(1600, 0, 1);
  const std::vector<double> p = probabilities(candidates, seen);
  const auto lights = chosen(seen, list_of(candidates), 8);
  ASSERT_EQ(lights.size(), 200u);
  int checked = 0;
  for (size_t k = 0; k < lights.size(); ++k) {
    const double place = (double(k) + 0.5) / 200.0;
    size_t i = 0;
    double sum = p[0];
    while (sum <= place) sum += p[++i];
    if (std::min(sum - place, place - (sum - p[i])) < 1e-5) continue;  // rounding may choose the neighbour
    ++checked;
    EXPECT_EQ(lights[k].position, candidates[i].position) << k;
    const double share = 1.0 / (200.0 * p[i]);
    EXPECT_NEAR(double(lights[k].flux.g) / (share * double(candidates[i].flux.g)), 1.0, 1e-2) << k;
    EXPECT_NEAR(double(lights[k].area_m2) / (share * double(candidates[i].area_m2)), 1.0, 1e-2) << k;
  }
  EXPECT_GT(checked, 180);
}

// The sum over what is chosen is a midpoint rule for the sum over the candidates: its error is at most the variation of
// flux over probability, of count. Over many orders of the candidates it is right in the mean.
TEST_F(ResampleVirtualLightsTest, KeepTheSumOfFlux) {
  Seen seen = stage_seen(context());
  auto candidates = candidates_of(800, 0, 2);
  const double exact = sum_of_flux(candidates).r;
  std::mt19937 random(3);
  double sum = 0.0, squares = 0.0, largest_bound = 0.0;
  constexpr int kOrders = 40;
  for (int order = 0; order < kOrders; ++order) {
    std::shuffle(candidates.begin(), candidates.end(), random);
    const std::vector<double> p = probabilities(candidates, seen);
    double variation = 0.0;
    for (size_t i = 1; i < p.size(); ++i)
      variation += std::abs(double(candidates[i].flux.r) / p[i] - double(candidates[i - 1].flux.r) / p[i - 1]);
    const double error = sum_of_flux(chosen(seen, list_of(candidates), 8)).r - exact;
    EXPECT_LT(std::abs(error), variation / 100.0);
    largest_bound = std::max(largest_bound, variation / 100.0);
    sum += error / exact;
    squares += error * error / (exact * exact);
  }
  const double mean = sum / kOrders, deviation = std::sqrt(squares / kOrders);
  RecordProperty("mean", std::to_string(mean));
  RecordProperty("deviation", std::to_string(deviation));
  EXPECT_LT(std::abs(mean), 4.0 * deviation / std::sqrt(double(kOrders)));
  EXPECT_LT(deviation, 0.5);
}

TEST_F(ResampleVirtualLightsTest, EverySourceKeepsItsNumber) {
  Seen seen = stage_seen(context());
  std::vector<VirtualLight> candidates;
  for (const auto& [count, source] : {std::pair(800, 0), {8, 2}, {1600, 3}}) {
    const auto of_source = candidates_of(count, source, unsigned(count));
    candidates.insert(candidates.end(), of_source.begin(), of_source.end());
  }
  auto emitted = candidates_of(240, -1, 9);
  for (VirtualLight& l : emitted) l.kind = VIRTUAL_LIGHT_EMITTED;
  VirtualLightListGl list = list_of(candidates, emitted);
  list.of_light = {800, 0, 8, 1600};
  ResampleVirtualLights choose(8);
  choose.run(list, seen.gbuffer, seen.timer);
  EXPECT_EQ(choose.lights().of_light, (std::vector<int>{100, 0, 1, 200}));
  EXPECT_EQ(choose.lights().reflected, 301);
  EXPECT_EQ(choose.lights().emitted, 30);
  const auto lights = download(choose.lights());
  for (size_t i = 0; i < lights.size(); ++i) {
    EXPECT_EQ(lights[i].source, i < 100 ? 0 : i == 100 ? 2 : i < 301 ? 3 : -1) << i;
    EXPECT_EQ(lights[i].kind, i < 301 ? VIRTUAL_LIGHT_REFLECTED : VIRTUAL_LIGHT_EMITTED) << i;
  }
  // Each source is chosen from as if it were alone.
  const auto alone = chosen(seen, list_of(candidates_of(1600, 3, 1600)), 8);
  EXPECT_EQ(std::memcmp(alone.data(), &lights[101], alone.size() * sizeof(VirtualLight)), 0);
}

TEST_F(ResampleVirtualLightsTest, LightsThatFaceAwayAreRare) {
  Seen seen = stage_seen(context());
  std::vector<VirtualLight> candidates;
  for (int i = 0; i < 800; ++i) {
    const int column = i % 40, row = i / 40;
    const glm::vec3 at(-1.5f + 3.0f * float(column) / 40.0f, 2.9f, -1.5f + 3.0f * float(row) / 20.0f);
    candidates.push_back(light_at(at, {0, i % 2 == 0 ? -1.0f : 1.0f, 0}));
  }
  std::shuffle(candidates.begin(), candidates.end(), std::mt19937(5));
  int away = 0;
  for (const VirtualLight& l : chosen(seen, list_of(candidates), 8)) away += l.normal.y > 0.0f;
  const double expected = 0.5 * double(ResampleVirtualLights::kFluxShare) * 100.0;
  EXPECT_GT(away, 0);
  EXPECT_NEAR(away, expected, 3.0 * std::sqrt(expected));
}

TEST_F(ResampleVirtualLightsTest, WithoutWeightsFluxDecidesAndWithoutFluxNothing) {
  Seen seen = stage_seen(context());
  auto candidates = candidates_of(800, 0, 4);
  for (VirtualLight& l : candidates) l.normal = {0, 1, 0}, l.position.y = 5.0f;  // above all, facing up
  const double exact = sum_of_flux(candidates).g;
  EXPECT_NEAR(sum_of_flux(chosen(seen, list_of(candidates), 8)).g / exact, 1.0, 0.1);
  double sum = 0.0;
  for (const VirtualLight& l : chosen(seen, list_of(candidates), 8)) sum += luminance(glm::dvec3(l.flux));
  double all = 0.0;
  for (const VirtualLight& l : candidates) all += luminance(glm::dvec3(l.flux));
  EXPECT_NEAR(sum / all, 1.0, 1e-3);  // chosen by flux, each carries the same
  for (VirtualLight& l : candidates) l.flux = glm::vec3(0.0f);
  for (const VirtualLight& l : chosen(seen, list_of(candidates), 8)) {
    EXPECT_EQ(l.flux, glm::vec3(0.0f));
    EXPECT_TRUE(std::isfinite(l.area_m2) && std::isfinite(glm::dot(l.position, l.position)));
  }
}

// 1: the paper's samples, as VirtualLights makes them.
TEST_F(ResampleVirtualLightsTest, OneOfOneIsNoChoice) {
  Scene scene = colourful_room();
  scene.lights = {point_light(kLamp, 2.5f)};
  screen::FrameOptions o;
  o.recipe = "vpl";
  o.size = {8, 8};
  o.of<screen::ReflectiveShadowMap::Resolution>() = kResolution;
  o.of<screen::VirtualLightOptions>().count = 100;
  o.of<screen::ResampleOptions>().candidates = 1;
  screen::Frame frame(scene, o);
  gl::PassTimer timer(context().software(), false);
  frame.render(framing_camera(scene.bounds_min, scene.bounds_max), timer);
  const auto plain = lights_of(context(), scene, {100, {}, Sampling::halton});
  const auto lights = frame.virtual_lights().lights;
  ASSERT_EQ(lights.size(), 100u);
  EXPECT_EQ(std::memcmp(plain.data(), lights.data(), lights.size() * sizeof(VirtualLight)), 0);
}

TEST(Hilbert, VisitsEveryCellAndNeighboursFollow) {
  constexpr int n = 32;
  std::vector<glm::ivec2> at(n * n, glm::ivec2(-1));
  for (int y = 0; y < n; ++y) {
    for (int x = 0; x < n; ++x) {
      const std::uint32_t cell = hilbert_index((glm::vec2(x, y) + 0.5f) / float(n)) >> 22;  // 2 (16 - 5) bits
      ASSERT_LT(cell, std::uint32_t(n * n));
      EXPECT_EQ(at[cell].x, -1) << "twice";
      at[cell] = {x, y};
    }
  }
  for (size_t i = 1; i < at.size(); ++i) {
    const glm::ivec2 step = glm::abs(at[i] - at[i - 1]);
    EXPECT_EQ(step.x + step.y, 1) << i;
  }
  EXPECT_EQ(at.front(), glm::ivec2(0, 0));
  EXPECT_EQ(at.back(), glm::ivec2(n - 1, 0));
  EXPECT_EQ(hilbert_index({-1.0f, -1.0f}), hilbert_index({0.0f, 0.0f}));
  EXPECT_EQ(hilbert_index({2.0f, 0.0f}), 0xffffffffu);
}

}  // namespace
}  // namespace volgi::test
