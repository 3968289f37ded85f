// Upsampling of known light over known surfaces: ramps and steps, no halo, and the same in double.
#include "screen/gather/subsplats/upsample.h"

#include <numeric>

#include "screen/gather/subsplats/light_cache.h"
#include "screen/gather/subsplats/stencil_gather.h"
#include "tests/screen/gather/subsplats/subsplat_scene.h"
#include "tests/support/gl_test.h"

namespace volgi::test {
namespace {

using screen::Upsample;
using screen::UpsampleOptions;
using Rendered = UpsampleOptions::Rendered;
/// Irradiance at a place of the picture [pixels], the middle of the first one at (0.5, 0.5).
using Light = std::function<float(double x, double y)>;

/// The middle of what a subsplat shows of the picture.
glm::dvec2 middle_of(Subsplat s, glm::ivec2 size) {
  const glm::dvec2 first(s.texel * (1 << s.level)), end((s.texel + 1) * (1 << s.level));
  return 0.5 * (first + glm::min(end, glm::dvec2(size)));
}

/// §3.2.5 in double, as the pseudo-code has it.
class UpsampleOracle {
 public:
  UpsampleOracle(const SubsplatLevels& levels, const std::vector<glm::vec4>& rendered, Rendered keep)
      : levels_(levels), keep_(keep) {
    for (int level = 0; level <= levels.last; ++level) {
      const glm::ivec2 size = shared::level_size(levels.size, level);
      std::vector<glm::dvec2> of_level;  // light, and whether there is any
      for (int y = 0; y < size.y; ++y) {
        for (int x = 0; x < size.x; ++x) {
          const glm::ivec2 at = shared::level_corner(levels.size, level) + glm::ivec2(x, y);
          const glm::vec4 r = rendered[size_t(at.y) * size_t(levels.flattened().x) + size_t(at.x)];
          of_level.emplace_back(r.w > 0.0f ? double(r.x) : 0.0, r.w > 0.0f ? 1.0 : 0.0);
        }
      }
      rendered_.push_back(std::move(of_level));
    }
  }
  std::vector<glm::dvec2> run() const {
    std::vector<glm::dvec2> coarser;
    for (int level = levels_.last; level >= 0; --level) coarser = level_of(level, coarser);
    return coarser;
  }

 private:
  std::vector<glm::dvec2> level_of(int level, const std::vector<glm::dvec2>& coarser) const {
    const glm::ivec2 size = shared::level_size(levels_.size, level);
    const int coarser_width = shared::level_size(levels_.size, level + 1).x;
    const auto data = [&](int x, int y) {
      const glm::dvec2 own = rendered_[size_t(level)][size_t(y * size.x + x)];
      if (own.y > 0.0 || coarser.empty()) return own;
      return coarser[size_t((y >> 1) * coarser_width + (x >> 1))];
    };
    std::vector<glm::dvec2> out;
    for (int y = 0; y < size.y; ++y) {
      for (int x = 0; x < size.x; ++x) {
        glm::dvec2 sum(0.0);
        for (int v = std::max(y - 1, 0); v <= std::min(y + 1, size.y - 1); ++v) {
          for (int u = std::max(x - 1, 0); u <= std::min(x + 1, size.x - 1); ++u) {
            const double weight = (2 - std::abs(u - x)) * (2 - std::abs(v - y));
            if (data(u, v).y > 0.0) sum += weight * glm::dvec2(data(u, v).x, 1.0);
          }
        }
        const bool stays = keep_ == Rendered::kept && rendered_[size_t(level)][size_t(y * size.x + x)].y > 0.0;
        if (data(x, y).y == 0.0) {
          out.emplace_back(0.0, 0.0);
        } else {
          out.push_back(stays ? data(x, y) : glm::dvec2(sum.x / sum.y, 1.0));
        }
      }
    }
    return out;
  }
  SubsplatLevels levels_;
  Rendered keep_;
  std::vector<std::vector<glm::dvec2>> rendered_;
};

class UpsampleTest : public GlTest {
 protected:
  struct Picture {
    std::vector<double> light;  // at every pixel
    size_t fragments = 0;
  };
  /// Light at the subsplats that `pixels` is made of, upsampled; and the oracle's answer checked against it.
  static Picture upsampled(PaintedPixels& pixels, const Light& light, bool borders, Rendered keep, int cells = 8) {
    const SubsplatLevels levels = SubsplatLevels::of(pixels.size, cells, 1);
    DiscontinuityOptions o;
    o.criterion = DiscontinuityOptions::Criterion::depth;
    o.borders = borders;
    DiscontinuityMipmaps mipmaps(levels, o);
    mipmaps.run(pixels.gbuffer, straight_camera(), 10.0f, pixels.timer);
    FlattenedBuffer buffer(levels);
    buffer.clear();
    buffer.mark(pixels.gbuffer, mipmaps, pixels.timer);
    screen::LightCache cache;
    cache.run(list_of({light_at({0, 0, 5}, {0, 0, -1})}), nullptr, pixels.timer);
    screen::StencilGather(screen::LightForm::disk, 1.0f).run(pixels.gbuffer, buffer, cache, {}, pixels.timer);
    std::vector<glm::vec4> values = texels(buffer.irradiance());
    for (const glm::uint packed : lit_set(buffer)) {
      const Subsplat s = shared::unpack_subsplat(packed);
      const glm::ivec2 at = shared::place_of_subsplat(pixels.size, s);
      const glm::dvec2 middle = middle_of(s, pixels.size);
      values[size_t(at.y) * size_t(levels.flattened().x) + size_t(at.x)] =
          glm::vec4(glm::vec3(light(middle.x, middle.y)), 1.0f);
    }
    glTextureSubImage2D(buffer.irradiance().id(), 0, 0, 0, levels.flattened().x, levels.flattened().y, GL_RGBA,
                        GL_FLOAT, values.data());
    Upsample upsample(levels, {.rendered = keep});
    upsample.run(pixels.gbuffer, straight_camera(), buffer.irradiance(), pixels.timer);
    Picture picture;
    picture.fragments = lit_set(buffer).size();
    for (const glm::vec4& p : texels(upsample.radiance())) picture.light.push_back(double(p.x) * glm::pi<double>());
    const std::vector<glm::dvec2> expected = UpsampleOracle(levels, values, keep).run();
    for (size_t i = 0; i < expected.size(); ++i) {
      if (expected[i].y > 0.0) {
        EXPECT_NEAR(picture.light[i], expected[i].x, 2e-5);
      }
    }
    return picture;
  }
};

// Bilinear between middles of squares, whatever the level: a ramp is found again. At the picture's edge the tent has a
// side less: the outermost square shows what its inner neighbour takes it to, a third of the way, and its own middle's
// light to the edge, half a square more.
TEST_F(UpsampleTest, ARampIsInterpolatedExactly) {
  const glm::ivec2 size(128, 96);
  PaintedPixels pixels(context(), size, [](int, int) { return 5.0f; });
  const Light ramp = [](double x, double y) { return float(2.0 + 0.004 * x - 0.003 * y); };
  for (const Rendered keep : {Rendered::printed, Rendered::kept}) {
    const Picture got = upsampled(pixels, ramp, false, keep);
    EXPECT_EQ(got.fragments, 48u);  // squares of 16
    double inside = 0.0, anywhere = 0.0;
    for (int y = 0; y < size.y; ++y) {
      for (int x = 0; x < size.x; ++x) {
        const double error =
            std::abs(got.light[size_t(y * size.x + x)] - double(ramp(double(x) + 0.5, double(y) + 0.5)));
        const int edge = std::min({x, y, size.x - 1 - x, size.y - 1 - y});
        anywhere = std::max(anywhere, error);
        if (edge >= 32) inside = std::max(inside, error);
      }
    }
    EXPECT_LT(inside, 2e-5);
    EXPECT_LT(anywhere, 0.007 * 16.0 * (1.0 / 3.0 + 1.0 / 2.0));
  }
}

/// Largest error where a plate in front of a wall has other light, and how many pixels are wrong at all.
struct Halo {
  double worst = 0.0;
  int pixels = 0;
};

Halo halo_of(const std::vector<double>& light, glm::ivec2 size, const std::function<bool(int, int)>& is_plate) {
  Halo halo;
  for (int y = 0; y < size.y; ++y) {
    for (int x = 0; x < size.x; ++x) {
      const double error = std::abs(light[size_t(y * size.x + x)] - (is_plate(x, y) ? 1.0 : 0.25));
      halo.worst = std::max(halo.worst, error);
      halo.pixels += error > 1e-4 ? 1 : 0;
    }
  }
  return halo;
}

// Wherever the edge lies on the squares. Kept, no pixel has anything of the other side; printed, the finest level's own
// interpolation takes a quarter (an eighth at a corner) across, one pixel wide.
TEST_F(UpsampleTest, AStepHasNoHalo) {
  const glm::ivec2 size(96, 48);
  for (int at = 40; at < 57; ++at) {
    const auto is_plate = [at](int x, int) { return x < at; };
    PaintedPixels pixels(context(), size, [&](int x, int y) { return is_plate(x, y) ? 5.0f : 8.0f; });
    const Light light = [&](double x, double) { return x < double(at) ? 1.0f : 0.25f; };
    const Halo kept = halo_of(upsampled(pixels, light, true, Rendered::kept).light, size, is_plate);
    EXPECT_LT(kept.worst, 1e-5) << at;
    const Halo printed = halo_of(upsampled(pixels, light, true, Rendered::printed).light, size, is_plate);
    EXPECT_LT(printed.worst, 0.75 * 0.25 + 1e-4) << at;
    EXPECT_LE(printed.pixels, 2 * size.y) << at;
  }
}

TEST_F(UpsampleTest, ASlantingStepHasNoHalo) {
  const glm::ivec2 size(96, 72);
  const auto is_plate = [](int x, int y) { return 3 * x + 2 * y < 200; };
  PaintedPixels pixels(context(), size, [&](int x, int y) { return is_plate(x, y) ? 5.0f : 8.0f; });
  const Light light = [&](double x, double y) { return is_plate(int(x), int(y)) ? 1.0f : 0.25f; };
  EXPECT_LT(halo_of(upsampled(pixels, light, true, Rendered::kept).light, size, is_plate).worst, 1e-5);
}

// §3.4.2, figure 3.13: an edge on the border of squares is no discontinuity of theirs; borders see it.
TEST_F(UpsampleTest, AnEdgeBetweenSquaresNeedsBorders) {
  const glm::ivec2 size(96, 48);
  const auto is_plate = [](int x, int) { return x < 48; };
  PaintedPixels pixels(context(), size, [&](int x, int y) { return is_plate(x, y) ? 5.0f : 8.0f; });
  const Light light = [](double x, double) { return x < 48.0 ? 1.0f : 0.25f; };
  const Picture without = upsampled(pixels, light, false, Rendered::kept),
                with = upsampled(pixels, light, true, Rendered::kept);
  EXPECT_GT(halo_of(without.light, size, is_plate).worst, 0.1);
  EXPECT_LT(halo_of(with.light, size, is_plate).worst, 1e-5);
  EXPECT_GT(with.fragments, without.fragments);
}

// Nothing goes into the background or comes from it.
TEST_F(UpsampleTest, BackgroundTakesNoPart) {
  const glm::ivec2 size(80, 60);
  const auto is_disk = [](int x, int y) { return (x - 40) * (x - 40) + (y - 30) * (y - 30) < 400; };
  PaintedPixels pixels(context(), size, [&](int x, int y) { return is_disk(x, y) ? 5.0f : 0.0f; });
  for (const Rendered keep : {Rendered::printed, Rendered::kept}) {
    const Picture got = upsampled(
        pixels, [](double, double) { return 0.75f; }, false, keep);
    for (int y = 0; y < size.y; ++y) {
      for (int x = 0; x < size.x; ++x)
        EXPECT_NEAR(got.light[size_t(y * size.x + x)], is_disk(x, y) ? 0.75 : 0.0, 1e-5) << x << ' ' << y;
    }
  }
}

// Eq. 3.3: alpha 0 leaves light alone, alpha 1 is the cosine with the viewer.
TEST_F(UpsampleTest, DetailIsByTheCosineWithTheViewer) {
  const glm::ivec2 size(16, 16);
  PaintedPixels pixels(context(), size, [](int, int) { return 5.0f; });
  const SubsplatLevels levels = SubsplatLevels::of(size, 16, 1);
  FlattenedBuffer buffer(levels);
  buffer.clear();
  const std::vector<glm::vec4> ones(256, glm::vec4(1.0f));
  glTextureSubImage2D(buffer.irradiance().id(), 0, 0, 0, 16, 16, GL_RGBA, GL_FLOAT, ones.data());
  for (const float detail : {0.0f, 0.5f, 1.0f}) {
    Upsample upsample(levels, {.detail = detail});
    upsample.run(pixels.gbuffer, straight_camera(), buffer.irradiance(), pixels.timer);
    const std::vector<glm::vec4> got = texels(upsample.radiance());
    for (int y = 0; y < 16; ++y) {
      for (int x = 0; x < 16; ++x) {
        const double cosine = 5.0 / std::sqrt(25.0 + double(x * x + y * y));
        EXPECT_NEAR(double(got[size_t(16 * y + x)].x) * glm::pi<double>(),
                    double(detail) * cosine + 1.0 - double(detail), 1e-5);
      }
    }
  }
}

}  // namespace
}  // namespace volgi::test
