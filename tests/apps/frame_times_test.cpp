#include <gtest/gtest.h>

#include "apps/volgi/frame_times.h"
#include "core/error.h"

namespace volgi::app {
namespace {

TEST(FrameTimes, IncludeBothEnds) {
  const FrameTimes second = parse_frame_times("0:1:25");
  EXPECT_EQ(second.count, 26);
  EXPECT_EQ(second.at(0), 0.0);
  EXPECT_EQ(second.at(25), 1.0);
  EXPECT_EQ(parse_frame_times("1.5:1.5:24").count, 1);
  EXPECT_EQ(parse_frame_times("-2:0.05:10").count, 21);
  EXPECT_DOUBLE_EQ(parse_frame_times("-2:0.05:10").at(20), 0.0);
  for (int n = 1; n < 2000; ++n) {  // 0.3 * 10 is not 3
    EXPECT_EQ(parse_frame_times("0:" + std::to_string(n) + "e-1:10").count, n + 1);
  }
  EXPECT_EQ(parse_frame_times("0:99999:1").count, FrameTimes::kMaxCount);
}

TEST(FrameTimes, WrongUsageIsRefused) {
  for (const char* text : {"", "1", "0:1", "0:1:", ":1:25", "0:1:25:1", "0:1:x", "0:nan:25", "0:inf:25", "1:0:25",
                           "0:1:0", "0:1:-25", "0:100000:1", "0:1e300:1e300", "0 :1:25"}) {
    try {
      parse_frame_times(text);
      ADD_FAILURE() << text;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::usage);
      EXPECT_NE(std::string(error.what()).find(std::string("--animate '") + text + "'"), std::string::npos);
    }
  }
}

TEST(FrameTimes, NumberThePictures) {
  EXPECT_EQ(frame_path("a/out.png", 0), "a/out.0000.png");
  EXPECT_EQ(frame_path("out.exr", 12345), "out.12345.exr");
  EXPECT_EQ(frame_path("b.c/out_%03d.exr", 7), "b.c/out_007.exr");
  EXPECT_EQ(frame_path("%d.png", 12), "12.png");
  EXPECT_EQ(frame_path("a%04d/b%s.png", 1), "a%04d/b%s.0001.png");
}

}  // namespace
}  // namespace volgi::app
