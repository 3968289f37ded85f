// Every so-manieth allocation of reading a scene and of computing its volume fails: std::bad_alloc or an Error of
// limits comes out (exit code 5), nothing else, and the next run is as if nothing had happened.
#include <gtest/gtest.h>

#include <new>

#include "core/error.h"
#include "core/image.h"
#include "core/scene.h"
#include "propagation/light_in/direct_light_cpu.h"
#include "tests/hardcases/faults/failing_new.h"
#include "tests/support/paths.h"

namespace volgi::test {
namespace {

/// Allocations of `work` while none fails.
long allocations_of(const std::function<void()>& work) {
  failing_new.failing = 0;
  failing_new.count = 0;
  failing_new.counting = true;
  work();
  failing_new.counting = false;
  return failing_new.count;
}

enum class End { done, no_memory, wrong };

End end_of(const std::function<void()>& work, long failing) {
  failing_new.count = 0;
  failing_new.failing = failing;
  failing_new.counting = true;
  End end = End::done;
  try {
    work();
  } catch (const std::bad_alloc&) {
    end = End::no_memory;
  } catch (const Error& e) {
    end = e.code() == ExitCode::over_limit ? End::no_memory : End::wrong;
  } catch (...) {
    end = End::wrong;
  }
  failing_new.counting = false;
  return end;
}

/// VOLGI_FAULT_STEP: each how-manieth allocation fails; the suite has time for some 30 of each kind of work.
long step_of(long count) {
  const char* text = std::getenv("VOLGI_FAULT_STEP");
  return text != nullptr ? std::max(1L, std::atol(text)) : std::max(1L, count / 30);
}

void fail_everywhere(const std::function<void()>& work) {
  work();  // what is made once
  const long count = allocations_of(work), step = step_of(count);
  long failed = 0, runs = 0;
  for (long k = 1; k <= count; k += step, ++runs) {
    const End end = end_of(work, k);
    EXPECT_NE(end, End::wrong) << "allocation " << k << " of " << count;
    failed += end == End::no_memory;
  }
  EXPECT_GT(2 * failed, runs) << "hardly an allocation that fails is noticed";
  EXPECT_NO_THROW(work());
  testing::Test::RecordProperty("allocations", int(count));
  testing::Test::RecordProperty("failed", int(failed));
}

std::filesystem::path file(const char* name) { return source_dir() / "data" / name; }

TEST(Allocations, ReadingAScene) {
  fail_everywhere([] { load_scene(file("room704.glb")); });
}

TEST(Allocations, ReadingTextures) {
  fail_everywhere([] { load_scene(file("reference/scenes/area_tv.glb")); });
}

TEST(Allocations, ReadingAnExr) {
  fail_everywhere([] { read_exr(file("references/cornell.exr")); });
}

class Volumes : public testing::TestWithParam<Scheme> {};

TEST_P(Volumes, OnTheCpu) {
  const Scene scene = load_scene(file("cornell.glb"));
  VolumeOptions options;
  options.grid_cells = 8;
  options.scheme.scheme = GetParam();
  fail_everywhere([&] {
    VolumeCpu volume(scene, options);
    run_with_direct_light(volume, scene);
    volume.cells();
    volume.radiance();
    failing_new.counting = false;  // OpenVDB's trees allocate when they end: apps/volgi/failure.h says what becomes of it
  });
}

std::string name_of(const testing::TestParamInfo<Scheme>& of) {
  constexpr std::array names{"ordinates", "conservative", "lpv2009"};
  return names[of.index];
}

INSTANTIATE_TEST_SUITE_P(Schemes, Volumes, testing::Values(Scheme::ordinates, Scheme::conservative, Scheme::lpv2009),
                         name_of);

}  // namespace
}  // namespace volgi::test
