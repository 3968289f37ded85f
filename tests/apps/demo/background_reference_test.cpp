#include "apps/demo/background_reference.h"

#include <dirent.h>
#include <gtest/gtest.h>
#include <oneapi/tbb/parallel_for.h>
#include <sched.h>
#include <sys/resource.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstring>
#include <ctime>
#include <functional>
#include <set>
#include <thread>

#include "reference/progressive_path_tracer.h"
#include "tests/reference/scenes.h"

namespace volgi::demo {
namespace {

using namespace std::chrono_literals;
using test::add_box_inside, test::add_material, test::camera_at, test::point_light;

/// A box with white walls: paths are long in it.
std::shared_ptr<const Scene> box(float albedo = 0.7f) {
  auto scene = std::make_shared<Scene>();
  add_box_inside(*scene, add_material(*scene, glm::vec3(albedo)), glm::vec3(0.0f), glm::vec3(1.0f));
  scene->lights.push_back(point_light({0.2f, 0.5f, 0.1f}, glm::vec3(1.0f)));
  update_bounds(*scene);
  return scene;
}

const Camera INSIDE = camera_at({0.0f, 0.1f, 0.9f}, {0.0f, 0.0f, 0.0f}, 1.2f);

PathTracerOptions options(glm::ivec2 size, int samples) {
  PathTracerOptions o;
  o.size = size;
  o.samples_per_pixel = samples;
  return o;
}

/// False after a minute, which stands for never on any machine.
bool wait_for(const std::function<bool()>& condition) {
  for (int i = 0; i < 60000; ++i) {
    if (condition()) return true;
    std::this_thread::sleep_for(1ms);
  }
  return false;
}

std::set<int> threads_of_process() {
  std::set<int> ids;
  DIR* folder = opendir("/proc/self/task");
  while (const dirent* entry = readdir(folder))
    if (entry->d_name[0] != '.') ids.insert(std::atoi(entry->d_name));
  closedir(folder);
  return ids;
}

bool gives_way(int thread) {
  return sched_getscheduler(thread) == SCHED_IDLE || getpriority(PRIO_PROCESS, id_t(thread)) == 19;
}

int count_giving_way() {
  int count = 0;
  for (const int id : threads_of_process()) count += gives_way(id);
  return count;
}

bool same_bytes(const Image& a, const Image& b) {
  return a.pixels.size() == b.pixels.size() &&
         std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(glm::vec3)) == 0;
}

TEST(BackgroundReference, IsThePictureOfTheProgressivePathTracer) {
  const auto scene = box();
  const PathTracerOptions wanted = options({37, 21}, 5);
  ProgressivePathTracer tracer(*scene, INSIDE, wanted, ProgressivePathTracer::PointSets::two);
  tracer.trace(5);
  for (const int threads : {1, 3}) {
    BackgroundReference reference(threads);
    EXPECT_EQ(reference.latest(), nullptr);
    EXPECT_FALSE(reference.busy());
    reference.start(scene, INSIDE, wanted);
    ASSERT_TRUE(wait_for([&] { return !reference.busy(); }));
    const auto snapshot = reference.latest();
    ASSERT_NE(snapshot, nullptr);
    EXPECT_EQ(snapshot->samples, 5);
    EXPECT_GT(snapshot->seconds, 0.0);
    EXPECT_TRUE(same_bytes(snapshot->image, tracer.image()));
    EXPECT_TRUE(same_bytes(snapshot->noise, tracer.noise()));
    EXPECT_TRUE(reference.failure().empty());
  }
}

TEST(BackgroundReference, AnotherPictureOfTheSceneIsThatOfANewOne) {
  const auto scene = box(), other = box(0.3f);
  BackgroundReference reference(2);
  reference.start(scene, INSIDE, options({40, 30}, 3));
  ASSERT_TRUE(wait_for([&] { return reference.latest() != nullptr; }));
  const Camera elsewhere = camera_at({0.5f, -0.2f, 0.0f}, {-1.0f, 0.0f, 0.0f}, 0.9f);
  PathTracerOptions wanted = options({21, 48}, 4);
  wanted.light = PathTracerOptions::Light::indirect;
  for (const auto& at : {scene, other}) {
    reference.start(at, elsewhere, wanted);
    ASSERT_TRUE(wait_for([&] { return !reference.busy(); }));
    ProgressivePathTracer tracer(*at, elsewhere, wanted, ProgressivePathTracer::PointSets::two);
    tracer.trace(4);
    EXPECT_TRUE(same_bytes(reference.latest()->image, tracer.image()));
  }
}

TEST(BackgroundReference, SamplesGrowAndOldPicturesDoNotComeBack) {
  const auto bright = box(0.7f), dark = box(0.0f);
  BackgroundReference reference(2);
  reference.start(bright, INSIDE, options({32, 32}, 1 << 20));
  int last = 0;
  for (int seen = 0; seen < 4; ++seen) {
    ASSERT_TRUE(wait_for([&] { return reference.latest() && reference.latest()->samples > last; }));
    last = reference.latest()->samples;
  }
  PathTracerOptions indirect = options({16, 16}, 1 << 20);
  indirect.light = PathTracerOptions::Light::indirect;
  reference.start(dark, INSIDE, indirect);  // black walls reflect nothing
  ASSERT_TRUE(wait_for([&] {
    const auto snapshot = reference.latest();
    if (!snapshot) return false;
    EXPECT_EQ(snapshot->image.width, 16);
    EXPECT_EQ(snapshot->image.pixels[7], glm::vec3(0.0f));
    return snapshot->samples > 3;
  }));
}

TEST(BackgroundReference, TenQuickStartsLeaveNoThreadBehind) {
  const std::set<int> before = threads_of_process();
  for (int round = 0; round < 3; ++round) {
    BackgroundReference reference(3);
    for (int i = 0; i < 10; ++i) {
      reference.start(i % 3 == 0 ? box() : box(0.4f), INSIDE, options({64, 48}, 1 << 20));
      if (i % 4 == 1) std::this_thread::sleep_for(3ms);
      if (i % 4 == 2) reference.stop();
    }
    EXPECT_LE(threads_of_process().size(), before.size() + 3);
    ASSERT_TRUE(wait_for([&] { return reference.latest() != nullptr; }));
  }
  // The system forgets a thread a little after it was joined.
  EXPECT_TRUE(wait_for([&] { return threads_of_process() == before; }));
}

/// Processor time of the whole process [s].
double processor_s() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
}

// Processor time rather than time: threads that give way may wait long for a busy machine.
TEST(BackgroundReference, StopLetsGoWithinAPixel) {
  BackgroundReference reference(2);
  // White: hundreds of reflections until roulette ends a path; one sample of the picture takes seconds.
  reference.start(box(0.995f), INSIDE, options({128, 128}, 1 << 20));
  const double begin = processor_s();
  ASSERT_TRUE(wait_for([&] { return processor_s() > begin + 0.2; }));
  EXPECT_TRUE(reference.busy());
  const double at_stop = processor_s();
  reference.stop();
  ASSERT_TRUE(wait_for([&] { return !reference.busy(); }));
  EXPECT_LT(processor_s() - at_stop, 0.1);
  EXPECT_EQ(reference.latest(), nullptr);
  // Nothing goes on behind its back, and it can be started again.
  reference.start(box(), INSIDE, options({8, 8}, 2));
  ASSERT_TRUE(wait_for([&] { return !reference.busy(); }));
  EXPECT_EQ(reference.latest()->samples, 2);
  reference.stop();
  EXPECT_EQ(reference.latest()->samples, 2);
}

TEST(BackgroundReference, GivesWayAndNobodyElseDoes) {
  if (count_giving_way() > 0) GTEST_SKIP() << "the test itself runs at the lowest priority";
  {
    BackgroundReference reference(2);
    reference.start(box(), INSIDE, options({256, 256}, 1 << 20));
    ASSERT_TRUE(wait_for([&] { return count_giving_way() == 2; }));
    ASSERT_TRUE(wait_for([&] { return reference.latest() != nullptr; }));
    // Workers of TBB that are started while it traces.
    std::atomic<int> giving_way{0};
    tbb::parallel_for(0, 1000, [&](int) {
      giving_way += gives_way(0);
      std::this_thread::sleep_for(20us);
    });
    EXPECT_EQ(giving_way, 0);
    EXPECT_EQ(count_giving_way(), 2);
  }
  EXPECT_TRUE(wait_for([] { return count_giving_way() == 0; }));
}

TEST(ReferenceFigures, NoiseOfTheReferenceIsTakenOut) {
  const auto scene = box(0.5f);
  const PathTracerOptions wanted = options({24, 24}, 256);
  ProgressivePathTracer truth(*scene, INSIDE, [&] {
    PathTracerOptions o = wanted;
    o.seed = 77;
    return o;
  }());
  truth.trace(512);
  for (const int samples : {1, 4, 7, 32}) {
    ProgressivePathTracer tracer(*scene, INSIDE, wanted, ProgressivePathTracer::PointSets::two);
    tracer.trace(samples);
    const ReferenceSnapshot snapshot{tracer.image(), tracer.noise(), samples, 1.0};
    Image brighter = truth.image();
    for (glm::vec3& p : brighter.pixels) p *= 1.1f;
    const Metrics m = figures(brighter, snapshot);
    ASSERT_TRUE(m.relative);
    EXPECT_NEAR(m.relative->ratio, 1.1, 0.02);
    EXPECT_EQ(m.relative->rmse_pct_denoised.has_value(), samples > 1);
    if (samples == 1) continue;
    // 10 % of each pixel, 11.4 % in the root mean square of this picture; its own noise is up to as much.
    const Metrics exact = figures(brighter, {truth.image(), {}, 512, 1.0});
    EXPECT_NEAR(*m.relative->rmse_pct_denoised, exact.relative->rmse_pct, 1.0) << samples;
  }
}

TEST(ReferenceFigures, ErrorMapIsRedWhereTooBright) {
  const Image reference(8, 8, glm::vec3(1.0f));
  Image picture = reference;
  picture.at(2, 3) = glm::vec3(3.0f);
  picture.at(4, 5) = glm::vec3(0.0f);
  const Image map = signed_error_map(picture, reference);
  EXPECT_EQ(map.at(2, 3), glm::vec3(1, 0, 0));
  EXPECT_EQ(map.at(4, 5), glm::vec3(0, 0, 1));
  EXPECT_EQ(map.at(0, 0), glm::vec3(1, 1, 1));
}

}  // namespace
}  // namespace volgi::demo
