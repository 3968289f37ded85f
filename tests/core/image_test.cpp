#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <gtest/gtest.h>
#include <stb/stb_image.h>
#include <sys/stat.h>

#include <cmath>
#include <fstream>
#include <limits>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/image.h"
#include "tests/support/gltf_writer.h"

namespace volgi {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;

Image gradient(int width, int height) {
  Image image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) image.at(x, y) = {float(x), float(y) * 0.37f, -1e-3f * float(x * y)};
  }
  return image;
}

ExitCode code_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    return error.code();
  }
  return ExitCode::done;
}

size_t file_count(const fs::path& folder) {
  return size_t(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

struct Pixels {
  int width = 0, height = 0;
  std::vector<int> rgb;
};

Pixels read_png(const fs::path& path) {
  Pixels out;
  int channels = 0;
  stbi_uc* data = stbi_load(path.c_str(), &out.width, &out.height, &channels, 3);
  if (data != nullptr) out.rgb.assign(data, data + 3 * out.width * out.height);
  stbi_image_free(data);
  return out;
}

TEST(Exr, FloatRoundTripIsExact) {
  const TemporaryFolder folder;
  Image image = gradient(7, 5);
  image.at(3, 2) = {1e30f, std::numeric_limits<float>::infinity(), 1e-30f};
  write_exr(folder / "a.exr", image);
  const Image read = read_exr_rgb(folder / "a.exr");
  ASSERT_EQ(read.width, 7);
  ASSERT_EQ(read.height, 5);
  EXPECT_EQ(read.pixels, image.pixels);
  EXPECT_EQ(file_count(folder.path()), 1u);
}

TEST(Exr, NanSurvives) {
  const TemporaryFolder folder;
  Image image(2, 1);
  image.at(1, 0).y = std::nanf("");
  write_exr(folder / "a.exr", image);
  EXPECT_TRUE(std::isnan(read_exr_rgb(folder / "a.exr").at(1, 0).y));
}

TEST(Exr, HalfRoundTripIsWithinHalfPrecision) {
  const TemporaryFolder folder;
  const Image image = gradient(7, 5);
  write_exr(folder / "a.exr", image, true);
  const Image read = read_exr_rgb(folder / "a.exr");
  bool differs = false;
  for (size_t i = 0; i < image.pixels.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(read.pixels[i][c], image.pixels[i][c], std::abs(image.pixels[i][c]) * 0.0005f + 1e-7f);
      differs = differs || read.pixels[i][c] != image.pixels[i][c];
    }
  }
  EXPECT_TRUE(differs);  // it was stored as half
}

TEST(Exr, HalfRefusesToOverflow) {
  const TemporaryFolder folder;
  Image image(2, 2);
  image.at(1, 1).z = 65504.0f;
  EXPECT_EQ(code_of([&] { write_exr(folder / "a.exr", image, true); }), ExitCode::done);
  image.at(1, 1).z = -65505.0f;
  EXPECT_EQ(code_of([&] { write_exr(folder / "b.exr", image, true); }), ExitCode::over_limit);
  EXPECT_FALSE(fs::exists(folder / "b.exr"));
}

TEST(Exr, LayersByPrefix) {
  const TemporaryFolder folder;
  ChannelImage channels;
  channels.add_rgb("", Image(3, 2, {1, 2, 3}));
  channels.add_rgb("direct.", Image(3, 2, {4, 5, 6}));
  channels.add_xyz("position.", Image(3, 2, {7, 8, 9}));
  write_exr(folder / "a.exr", channels);
  const ChannelImage read = read_exr(folder / "a.exr");
  EXPECT_EQ(read.channels.size(), 9u);
  Image image;
  ASSERT_TRUE(read.rgb("position.", image));
  EXPECT_EQ(image.at(2, 1), glm::vec3(7, 8, 9));
  ASSERT_TRUE(read.rgb("direct.", image));
  EXPECT_EQ(image.at(0, 0), glm::vec3(4, 5, 6));
  EXPECT_FALSE(read.rgb("absent.", image));
  EXPECT_EQ(image.at(0, 0), glm::vec3(4, 5, 6));
  EXPECT_EQ(read.find("direct.G")->values[0], 5.0f);
  EXPECT_EQ(read.find("direct"), nullptr);
}

TEST(Exr, BlendersCombinedLayerIsTheColour) {
  const TemporaryFolder folder;
  ChannelImage channels;
  channels.add_rgb("ViewLayer.Combined.", Image(2, 2, {1, 2, 3}));
  channels.add_rgb("ViewLayer.DiffDir.", Image(2, 2, {4, 5, 6}));
  write_exr(folder / "a.exr", channels);
  EXPECT_EQ(read_exr_rgb(folder / "a.exr").at(1, 1), glm::vec3(1, 2, 3));
}

TEST(Exr, DataWindowAwayFromTheOrigin) {
  const TemporaryFolder folder;
  const Imath::Box2i window(Imath::V2i(-3, 10), Imath::V2i(0, 11));
  Imf::Header header(window, window);
  const std::vector<float> values = {1, 2, 3, 4, 5, 6, 7, 8};
  Imf::FrameBuffer frame;
  for (const char* name : {"R", "G", "B"}) {
    header.channels().insert(name, Imf::Channel(Imf::FLOAT));
    frame.insert(name, Imf::Slice::Make(Imf::FLOAT, values.data(), window));
  }
  {
    Imf::OutputFile file((folder / "a.exr").c_str(), header);
    file.setFrameBuffer(frame);
    file.writePixels(2);
  }
  const Image image = read_exr_rgb(folder / "a.exr");
  ASSERT_EQ(image.width, 4);
  EXPECT_EQ(image.at(3, 1).x, 8.0f);
  EXPECT_EQ(image.at(0, 0).x, 1.0f);
}

TEST(Exr, BadFilesAreRefused) {
  const TemporaryFolder folder;
  EXPECT_EQ(code_of([&] { read_exr(folder / "none.exr"); }), ExitCode::bad_input);
  EXPECT_EQ(code_of([&] { read_exr(folder.path()); }), ExitCode::bad_input);
  test::write_bytes(folder / "text.exr", "this is not an image");
  EXPECT_EQ(code_of([&] { read_exr(folder / "text.exr"); }), ExitCode::bad_input);
  test::write_bytes(folder / "empty.exr", "");
  EXPECT_EQ(code_of([&] { read_exr(folder / "empty.exr"); }), ExitCode::bad_input);
  ChannelImage only_depth{1, 1, {{"Z", {1.0f}}}};
  write_exr(folder / "z.exr", only_depth);
  EXPECT_EQ(code_of([&] { read_exr_rgb(folder / "z.exr"); }), ExitCode::bad_input);
}

TEST(Exr, EveryTruncationIsRefused) {
  const TemporaryFolder folder;
  write_exr(folder / "a.exr", gradient(16, 16));
  std::ifstream stream(folder / "a.exr", std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(stream)), {});
  for (size_t length = 0; length + 1 < bytes.size(); length += 13) {
    test::write_bytes(folder / "cut.exr", bytes.substr(0, length));
    EXPECT_EQ(code_of([&] { read_exr(folder / "cut.exr"); }), ExitCode::bad_input) << length;
  }
}

TEST(Exr, UnwritableTargetsAreNamed) {
  const TemporaryFolder folder;
  EXPECT_EQ(code_of([&] { write_exr(folder / "no/such/folder.exr", Image(1, 1)); }), ExitCode::cannot_write);
  EXPECT_EQ(code_of([&] { write_exr(folder.path(), Image(1, 1)); }), ExitCode::cannot_write);
}

TEST(Png, DisplayValuesAreRoundedAndClamped) {
  const TemporaryFolder folder;
  Image image(2, 1);
  image.at(0, 0) = {0.5f, -3.0f, 7.0f};
  image.at(1, 0) = {std::nanf(""), std::numeric_limits<float>::infinity(), 1.0f};
  write_png_display(folder / "a.png", image);
  const Pixels png = read_png(folder / "a.png");
  EXPECT_EQ(png.width, 2);
  EXPECT_EQ(png.rgb, (std::vector<int>{128, 0, 255, 0, 255, 255}));
  EXPECT_EQ(file_count(folder.path()), 1u);
}

TEST(Png, LinearValuesAreExposedToneMappedAndEncoded) {
  const TemporaryFolder folder;
  Image image(2, 1);
  image.at(0, 0) = glm::vec3(0.1f);
  image.at(1, 0) = {std::nanf(""), std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity()};
  write_png(folder / "a.png", image, 1.0f);
  const int expected = int(std::lround(255.0f * srgb_encode(0.2f - 0.04f)));
  const Pixels png = read_png(folder / "a.png");
  EXPECT_EQ(std::vector<int>(png.rgb.begin(), png.rgb.begin() + 3), std::vector<int>(3, expected));
  EXPECT_EQ(png.rgb[4], 255);
}

TEST(AtomicFile, FailureLeavesTheOldFileAndNothingElse) {
  const TemporaryFolder folder;
  test::write_bytes(folder / "a.txt", "old");
  const auto failing = [](const fs::path& temporary) {
    test::write_bytes(temporary, "half");
    throw Error(ExitCode::over_limit, "stopped");
  };
  EXPECT_EQ(code_of([&] { write_atomically(folder / "a.txt", failing); }), ExitCode::over_limit);
  EXPECT_EQ(file_count(folder.path()), 1u);
  std::ifstream stream(folder / "a.txt");
  std::string text;
  stream >> text;
  EXPECT_EQ(text, "old");
}

TEST(AtomicFile, TargetAppearsOnlyWhenComplete) {
  const TemporaryFolder folder;
  write_atomically(folder / "a.png", [&](const fs::path& temporary) {
    EXPECT_EQ(temporary.parent_path(), folder.path());
    EXPECT_EQ(temporary.extension(), ".png");
    test::write_bytes(temporary, "new");
    EXPECT_FALSE(fs::exists(folder / "a.png"));
  });
  EXPECT_TRUE(fs::exists(folder / "a.png"));
  EXPECT_EQ(file_count(folder.path()), 1u);
}

TEST(AtomicFile, DevicesAndMissingOutputsAreRefused) {
  const TemporaryFolder folder;
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  const auto write = [](const fs::path& temporary) { test::write_bytes(temporary, "x"); };
  EXPECT_EQ(code_of([&] { write_atomically(folder / "pipe", write); }), ExitCode::cannot_write);
  EXPECT_TRUE(fs::is_fifo(folder / "pipe"));
  EXPECT_EQ(code_of([&] { write_atomically(folder / "a", [](const fs::path&) {}); }), ExitCode::cannot_write);
}

TEST(ToneMap, IsTheIdentityLessTheFresnelOffset) {
  EXPECT_EQ(tone_map(glm::vec3(0)), glm::vec3(0));
  const glm::vec3 middle = tone_map({0.3f, 0.5f, 0.6f});
  EXPECT_NEAR(middle.x, 0.26f, 1e-6f);
  EXPECT_NEAR(middle.y, 0.46f, 1e-6f);
  EXPECT_NEAR(tone_map(glm::vec3(0.04f)).x, 6.25f * 0.04f * 0.04f, 1e-6f);
}

TEST(ToneMap, RisesStaysBelowOneAndEndsWhite) {
  float last = 0.0f;
  for (float grey = 1e-3f; grey < 1e6f; grey *= 1.1f) {
    const float now = tone_map(glm::vec3(grey)).x;
    EXPECT_GT(now, last - 1e-6f) << grey;
    EXPECT_LE(now, 1.0f);
    last = now;
  }
  EXPECT_GT(last, 0.99f);
  const glm::vec3 bright_red = tone_map({1e5f, 1.0f, 1.0f});
  EXPECT_GT(bright_red.y, 0.9f);
  // Value of the specification at 1: 1 - 0.24^2 / (0.96 + 0.24 - 0.76).
  EXPECT_NEAR(tone_map(glm::vec3(1.0f)).x, 1.0f - 0.0576f / 0.44f, 1e-5f);
}

TEST(ToneMap, NoInputLeavesTheDisplayRange) {
  const float inf = std::numeric_limits<float>::infinity();
  for (const glm::vec3 in :
       {glm::vec3(-1, 2, 0.5f), glm::vec3(inf, 0, 0), glm::vec3(std::nanf("")), glm::vec3(-inf, inf, 3e38f)}) {
    const glm::vec3 out = tone_map(in);
    for (int c = 0; c < 3; ++c) {
      EXPECT_GE(out[c], 0.0f);
      EXPECT_LE(out[c], 1.0f);
    }
  }
}

TEST(Srgb, EncodeAndDecodeAreInverse) {
  for (int i = 0; i <= 255; ++i) EXPECT_NEAR(srgb_encode(srgb_decode(float(i) / 255.0f)), float(i) / 255.0f, 2e-6f);
  EXPECT_NEAR(srgb_decode(0.5f), 0.21404114f, 1e-6f);
}

}  // namespace
}  // namespace volgi
