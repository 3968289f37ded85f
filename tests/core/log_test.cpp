#include <gtest/gtest.h>

#include <thread>

#include "core/log.h"
#include "core/progress.h"

namespace volgi {
namespace {

TEST(Log, EachMessageIsPrintedOnce) {
  ::testing::internal::CaptureStderr();
  warn_once("the first thing");
  warn_once("another thing");
  warn_once("the first thing");
  EXPECT_EQ(::testing::internal::GetCapturedStderr(),
            "volgi: warning: the first thing\nvolgi: warning: another thing\n");
}

TEST(Log, QuietPrintsNothing) {
  ::testing::internal::CaptureStderr();
  set_quiet(true);
  EXPECT_TRUE(is_quiet());
  warn_once("unheard");
  set_quiet(false);
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST(Log, QuietDoesNotHideAWrongResult) {
  ::testing::internal::CaptureStderr();
  set_quiet(true);
  warn_of_wrong_result("not right");
  warn_of_wrong_result("not right");
  set_quiet(false);
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "volgi: warning: not right\n");
}

TEST(Progress, PrintsNothingWhereThereIsNoTerminal) {
  ::testing::internal::CaptureStderr();
  {
    Progress progress("work", 100);
    std::thread other([&] {
      for (int i = 0; i < 50; ++i) progress.advance();
    });
    for (int i = 0; i < 60; ++i) progress.advance();  // more than announced is harmless
    other.join();
    std::this_thread::sleep_for(std::chrono::milliseconds(1100));
    progress.advance();
  }
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST(Progress, ZeroStepsAreHarmless) {
  Progress progress("nothing", 0);
  progress.advance();
}

}  // namespace
}  // namespace volgi
