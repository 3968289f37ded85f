// Levels of a picture, the mipmaps of discontinuities over them against sums over pixels in double, and which subsplats
// a picture is made of: in one pass, by a geometry shader and by lists, all against the definition.
#include <random>

#include "screen/gather/subsplats/light_cache.h"
#include "screen/gather/subsplats/splat.h"
#include "screen/gather/subsplats/stencil_gather.h"
#include "screen/gather/subsplats/subsplat_refinement.h"
#include "tests/screen/gather/subsplats/subsplat_scene.h"
#include "tests/support/gl_test.h"

namespace volgi::test {
namespace {

using Criterion = DiscontinuityOptions::Criterion;
using screen::LightForm;
using screen::SubsplatRefinement;

TEST(SubsplatLevels, PlacesAreInversesOfOneAnother) {
  for (const glm::ivec2 size : {glm::ivec2(1, 1), {3, 70}, {70, 3}, {33, 17}, {128, 64}}) {
    const SubsplatLevels levels = SubsplatLevels::of(size, 4, 1);
    size_t there = 0, expected = 0;
    for (int level = 0; level <= levels.last; ++level) {
      const glm::ivec2 texels = shared::level_size(size, level);
      expected += size_t(texels.x * texels.y);
    }
    for (int y = 0; y < levels.flattened().y; ++y) {
      for (int x = 0; x < levels.flattened().x; ++x) {
        const Subsplat s = shared::subsplat_at(size, levels.last, {x, y});
        if (s.level < 0) continue;
        ++there;
        EXPECT_EQ(shared::place_of_subsplat(size, s), glm::ivec2(x, y));
        const Subsplat back = shared::unpack_subsplat(shared::pack_subsplat(s));
        EXPECT_EQ(back.level, s.level);
        EXPECT_EQ(back.texel, s.texel);
      }
    }
    EXPECT_EQ(there, expected) << size.x << ' ' << size.y;
  }
}

TEST(SubsplatLevels, HaveAsManyAsAskedFor) {
  const auto last = [](glm::ivec2 size, int cells, int finest) { return SubsplatLevels::of(size, cells, finest).last; };
  EXPECT_EQ(last({1024, 1024}, 16, 1), 6);  // 16^2 ... 1024^2, as in the thesis
  EXPECT_EQ(last({1024, 1024}, 1024, 1), 0);
  EXPECT_EQ(last({192, 192}, 16, 1), 3);
  EXPECT_EQ(last({64, 64}, 16, 32), 5);  // the finest level is there in any case
}

class DiscontinuityMipmapsTest : public GlTest {
 protected:
  static Scene curved_stage() {
    Scene scene = stage();
    add_sphere(scene, 1, {-0.6f, 0.5f, 0.9f}, 0.5f, 12);
    update_bounds(scene);
    return scene;
  }
  static DiscontinuityOptions options(Criterion criterion, bool borders = false) {
    DiscontinuityOptions o;
    o.criterion = criterion;
    o.borders = borders;
    return o;
  }
  /// Largest differences of a level of the mipmaps from the oracle's.
  static void expect_level(const Seen& seen, const SubsplatLevels& levels, const DiscontinuityMipmaps& mipmaps,
                           const SquareOracle& oracle, int level) {
    const std::vector<float> depths = mipmaps.depth_ranges().download(2), bends = mipmaps.bends().download(2);
    const std::vector<float> bits = mipmaps.discontinuities().download(1);
    const glm::ivec2 size = shared::level_size(seen.size, level), corner = shared::tower_corner(seen.size, level);
    int wrong = 0;
    for (int y = 0; y < size.y; ++y) {
      for (int x = 0; x < size.x; ++x) {
        const Square q = oracle.square({level, {x, y}});
        const size_t i = size_t(corner.y + y) * size_t(levels.tower().x) + size_t(corner.x + x);
        if (q.nearest < double(FAR_AWAY)) {
          EXPECT_NEAR(depths[2 * i], q.nearest, 1e-5 * q.nearest);
          EXPECT_NEAR(depths[2 * i + 1] / q.farthest, 1.0, 1e-5);
          EXPECT_NEAR(bends[2 * i], q.derivative, 2e-5);
          EXPECT_NEAR(bends[2 * i + 1], q.curvature, 3e-4);  // acos near 1 loses half of the digits of 1e-7
        }
        const int expected =
            (q.has_surface ? SUBSPLAT_HAS_SURFACE : 0) | (q.discontinuous ? SUBSPLAT_DISCONTINUOUS : 0);
        wrong += int(bits[i]) != expected ? 1 : 0;
      }
    }
    EXPECT_EQ(wrong, 0) << "level " << level;
  }
};

// Odd sizes, whose last squares are cut; 7 is no threshold's neighbour.
TEST_F(DiscontinuityMipmapsTest, HoldRangesOfDepthAndLargestBends) {
  const Scene scene = curved_stage();
  const Seen seen(context(), scene, stage_camera(scene), {75, 53});
  const SubsplatLevels levels = SubsplatLevels::of(seen.size, 8, 1);
  ASSERT_EQ(levels.last, 3);
  for (const bool borders : {false, true}) {
    const DiscontinuityOptions o = options(Criterion::derivative_curvature, borders);
    DiscontinuityMipmaps mipmaps(levels, o);
    gl::PassTimer timer(context().software(), false);
    mipmaps.run(seen.gbuffer, seen.camera, seen.diagonal_m, timer);
    const SquareOracle oracle(seen, o, seen.diagonal_m);
    for (int level = 1; level <= levels.last; ++level) expect_level(seen, levels, mipmaps, oracle, level);
  }
}

TEST_F(DiscontinuityMipmapsTest, HoldRangesOfNormals) {
  const Scene scene = curved_stage();
  const Seen seen(context(), scene, stage_camera(scene), {66, 45});
  const SubsplatLevels levels = SubsplatLevels::of(seen.size, 8, 1);
  const DiscontinuityOptions o = options(Criterion::depth_normal);
  DiscontinuityMipmaps mipmaps(levels, o);
  gl::PassTimer timer(context().software(), false);
  mipmaps.run(seen.gbuffer, seen.camera, seen.diagonal_m, timer);
  const SquareOracle oracle(seen, o, seen.diagonal_m);
  const std::vector<glm::vec4> least = texels(mipmaps.least_normals()), most = texels(mipmaps.most_normals());
  for (int level = 1; level <= levels.last; ++level) {
    const glm::ivec2 size = shared::level_size(seen.size, level), corner = shared::tower_corner(seen.size, level);
    for (int y = 0; y < size.y; ++y) {
      for (int x = 0; x < size.x; ++x) {
        const Square q = oracle.square({level, {x, y}});
        if (!q.has_surface) continue;
        const size_t i = size_t(corner.y + y) * size_t(levels.tower().x) + size_t(corner.x + x);
        for (int c = 0; c < 3;
             ++c) {  // half a step of 16 bits, and that of normals in the G-buffer is the oracle's too
          EXPECT_NEAR(least[i][c], q.least[c], 2e-5);
          EXPECT_NEAR(most[i][c], q.most[c], 2e-5);
        }
      }
    }
  }
}

class SubsplatSets : public DiscontinuityMipmapsTest {
 protected:
  struct Sets {
    std::set<glm::uint> expected, stencil, geometry, compute;
  };
  static std::set<glm::uint> listed(const Seen& seen, const SubsplatLevels& levels, const DiscontinuityMipmaps& mipmaps,
                                    SubsplatRefinement::By by) {
    gl::PassTimer timer(context().software(), false);
    SubsplatRefinement refinement(levels, by, SubsplatRefinement::For::all_lights, LightForm::disk);
    refinement.begin_frame();
    refinement.run(seen.gbuffer, mipmaps, timer);
    const std::vector<glm::uvec2> list = refinement.list();
    EXPECT_EQ(refinement.count(), list.size());
    std::set<glm::uint> set;
    for (const glm::uvec2& entry : list) set.insert(entry.x);
    EXPECT_EQ(set.size(), list.size()) << "one of them twice";
    return set;
  }
  static Sets sets(const Seen& seen, const SubsplatLevels& levels, const DiscontinuityOptions& o) {
    gl::PassTimer timer(context().software(), false);
    DiscontinuityMipmaps mipmaps(levels, o);
    mipmaps.run(seen.gbuffer, seen.camera, seen.diagonal_m, timer);
    FlattenedBuffer buffer(levels);
    buffer.clear();
    buffer.mark(seen.gbuffer, mipmaps, timer);
    screen::LightCache cache;
    cache.run(list_of({light_at({0, 2.9f, 0}, {0, -1, 0})}), nullptr, timer);
    screen::StencilGather(LightForm::disk, 1.0f).run(seen.gbuffer, buffer, cache, {}, timer);
    const SquareOracle oracle(seen, o, seen.diagonal_m);
    return {refined_set(oracle, levels, o.diagonals), lit_set(buffer),
            listed(seen, levels, mipmaps, SubsplatRefinement::By::geometry),
            listed(seen, levels, mipmaps, SubsplatRefinement::By::compute)};
  }
  /// How often each pixel with surface is covered: once.
  static void expect_covered_once(const Seen& seen, const std::set<glm::uint>& set) {
    std::vector<int> covered(seen.position.size());
    for (const glm::uint packed : set) {
      const Subsplat s = shared::unpack_subsplat(packed);
      const int edge = 1 << s.level;
      for (int y = s.texel.y * edge; y < std::min((s.texel.y + 1) * edge, seen.size.y); ++y) {
        for (int x = s.texel.x * edge; x < std::min((s.texel.x + 1) * edge, seen.size.x); ++x)
          ++covered[size_t(y) * size_t(seen.size.x) + size_t(x)];
      }
    }
    int wrong = 0;
    for (size_t i = 0; i < covered.size(); ++i) wrong += seen.position[i].w != 0.0f && covered[i] != 1 ? 1 : 0;
    EXPECT_EQ(wrong, 0);
  }
};

TEST_F(SubsplatSets, AreTheSameInOnePassAndStepByStep) {
  const Scene scene = curved_stage();
  const Seen seen(context(), scene, stage_camera(scene), {90, 70});
  struct Case {
    Criterion criterion;
    bool diagonals, borders;
    int finest;
  };
  for (const Case& c : {Case{Criterion::depth_normal, true, false, 1},
                        {Criterion::derivative_curvature, true, false, 1},
                        {Criterion::depth, false, false, 1},
                        {Criterion::normal, true, true, 1},
                        {Criterion::curvature, true, false, 4}}) {
    const SubsplatLevels levels = SubsplatLevels::of(seen.size, 8, c.finest);
    DiscontinuityOptions o = options(c.criterion, c.borders);
    o.diagonals = c.diagonals;
    const Sets all = sets(seen, levels, o);
    SCOPED_TRACE(int(c.criterion));
    EXPECT_GT(all.expected.size(), 100u);
    if (c.finest == 1) {
      EXPECT_LT(all.expected.size(), seen.position.size() * 3 / 4);
    }
    EXPECT_EQ(all.stencil, all.expected);
    EXPECT_EQ(all.geometry, all.expected);
    EXPECT_EQ(all.compute, all.expected);
    expect_covered_once(seen, all.expected);
  }
}

// §3.4.2: more is refined with diagonals and far more with borders (theirs: 2 to 3 %, and up to 40 % of the time).
TEST_F(SubsplatSets, GrowWithDiagonalsAndBorders) {
  const Scene scene = curved_stage();
  const Seen seen(context(), scene, stage_camera(scene), {128, 96});
  const SubsplatLevels levels = SubsplatLevels::of(seen.size, 8, 1);
  size_t counts[3];
  for (int k = 0; k < 3; ++k) {
    DiscontinuityOptions o = options(Criterion::depth_normal, k == 2);
    o.diagonals = k > 0;
    counts[k] = refined_set(SquareOracle(seen, o, seen.diagonal_m), levels, o.diagonals).size();
  }
  EXPECT_GT(counts[1], counts[0]);
  EXPECT_GT(counts[2], counts[1]);
}

// Lists for each light: all of T = 0 are refined to the end, none of a large T; each covers the picture once, and both
// ways make the same ones.
TEST_F(SubsplatSets, OfEachLightGoByWhatItGives) {
  const Scene scene = curved_stage();
  const Seen seen(context(), scene, stage_camera(scene), {48, 40});
  const SubsplatLevels levels = SubsplatLevels::of(seen.size, 8, 1);
  gl::PassTimer timer(context().software(), false);
  DiscontinuityMipmaps mipmaps(levels, options(Criterion::depth_normal));
  mipmaps.run(seen.gbuffer, seen.camera, seen.diagonal_m, timer);
  screen::LightCache cache;
  cache.run(list_of({light_at({0, 2.9f, 0}, {0, -1, 0}), light_at({-1.9f, 0.2f, 0.5f}, {1, 0, 0})}), nullptr, timer);
  const auto lists = [&](SubsplatRefinement::By by, float most_difference) {
    SubsplatRefinement refinement(levels, by, SubsplatRefinement::For::each_light, LightForm::disk);
    cache.bind_block(0);
    std::set<glm::uint> of_light[2];
    for (int first = 0; first < 2; first += refinement.lights_at_once()) {
      refinement.begin_frame();
      refinement.run(seen.gbuffer, mipmaps, first, std::min(2 - first, refinement.lights_at_once()), most_difference,
                     timer);
      for (const glm::uvec2& entry : refinement.list()) of_light[entry.y].insert(entry.x);
    }
    for (const std::set<glm::uint>& set : of_light) expect_covered_once(seen, set);
    return std::pair(of_light[0], of_light[1]);
  };
  using By = SubsplatRefinement::By;
  const auto coarse = lists(By::compute, 1e6f), middle = lists(By::compute, 2e-3f), fine = lists(By::compute, 0.0f);
  EXPECT_EQ(coarse.first, coarse.second);
  EXPECT_NE(middle.first, middle.second);
  EXPECT_LT(coarse.first.size(), middle.first.size());
  EXPECT_LT(middle.first.size(), fine.first.size());
  EXPECT_EQ(lists(By::geometry, 2e-3f), middle);
}

}  // namespace
}  // namespace volgi::test
