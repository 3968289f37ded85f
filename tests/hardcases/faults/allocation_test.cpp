// Every so-manieth allocation of reading a scene and of computing its volume fails: std::bad_alloc or an Error of
// limits comes out (exit code 5), nothing else, and the next run is as if nothing had happened.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <exception>
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

/// What a process of its own says of `work`: its exit code, or less than 0 for a signal. In this one nothing may have
/// used TBB, whose threads no child has.
int end_of_child(const std::function<int()>& work) {
  const pid_t child = fork();
  if (child == 0) {
    // OpenVDB's trees allocate in their destructors: apps/volgi/failure.h says what becomes of that.
    std::set_terminate([] { _exit(int(ExitCode::over_limit)); });
    _exit(work());
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

class Volumes : public testing::TestWithParam<Scheme> {
 protected:
  static void compute(const Scene& scene) {
    VolumeOptions options;
    options.grid_cells = 8;
    options.scheme.scheme = GetParam();
    VolumeCpu volume(scene, options);
    run_with_direct_light(volume, scene);
    volume.cells();
    volume.radiance();
  }
  /// Computes twice, the first time with an allocation that fails: the exit code.
  static int fail_and_go_on(long failing) {
    const Scene scene = load_scene(file("cornell.glb"));
    const End end = end_of([&] { compute(scene); }, failing);
    failing_new.failing = 0;
    compute(scene);
    return end == End::done        ? int(ExitCode::done)
           : end == End::no_memory ? int(ExitCode::over_limit)
                                   : int(ExitCode::bad_input);
  }
};

TEST_P(Volumes, OnTheCpu) {
  int ends[2] = {};
  ASSERT_EQ(pipe(ends), 0);
  long count = 0;
  ASSERT_EQ(end_of_child([&] {
              const Scene scene = load_scene(file("cornell.glb"));
              const long found = allocations_of([&] { compute(scene); });
              return write(ends[1], &found, sizeof found) == ssize_t(sizeof found) ? 0 : 1;
            }),
            0);
  ASSERT_EQ(read(ends[0], &count, sizeof count), ssize_t(sizeof count));
  close(ends[0]);
  close(ends[1]);
  long failed = 0, runs = 0;
  for (long k = 1; k <= count; k += step_of(count), ++runs) {
    const int end = end_of_child([&] { return fail_and_go_on(k); });
    EXPECT_TRUE(end == int(ExitCode::done) || end == int(ExitCode::over_limit))
        << "allocation " << k << " of " << count << " ends with " << end;
    failed += end == int(ExitCode::over_limit);
  }
  EXPECT_GT(2 * failed, runs) << "hardly an allocation that fails is noticed";
  RecordProperty("allocations", int(count));
  RecordProperty("failed", int(failed));
}

std::string name_of(const testing::TestParamInfo<Scheme>& of) {
  constexpr std::array names{"ordinates", "conservative", "lpv2009"};
  return names[of.index];
}

INSTANTIATE_TEST_SUITE_P(Schemes, Volumes, testing::Values(Scheme::ordinates, Scheme::conservative, Scheme::lpv2009),
                         name_of);

}  // namespace
}  // namespace volgi::test
