// Against pictures of an unrelated renderer (data/reference/README.md): direct light, one bounce, all bounces.
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <tuple>

#include "core/scene.h"
#include "core/sky.h"
#include "reference/metrics.h"
#include "reference/path_tracer.h"
#include "reference/picture_files.h"
#include "tests/support/paths.h"

namespace volgi {
namespace {

const std::string kData = (test::source_dir() / "data/reference").string() + "/";

class Independent : public testing::TestWithParam<std::tuple<std::string, std::string>> {};

TEST_P(Independent, BlockMeansAndEnergyAgree) {
  const auto& [scene_name, mode] = GetParam();
  Scene scene = load_scene(kData + "scenes/" + scene_name + ".glb");
  const bool sky = scene_name == "sky_court", metal = scene_name == "metal_box";
  if (sky) scene.sky = std::make_shared<Sky>(glm::vec3(1.0f, 1.1f, 1.3f));  // scenes/index.json
  const bool sampled = sky || scene_name == "area_tv";                      // also in direct light
  PathTracerOptions options;
  options.size = {192, 192};
  options.samples_per_pixel = mode == "direct" ? (sampled ? 64 : 2) : mode == "one" ? 256 : 128;
  if (mode != "full") options.max_bounces = mode == "one" ? 1 : 0;
  const ReferencePicture picture = path_trace(scene, scene.cameras.at(0), options);
  const std::string folder = kData + "ref/" + scene_name + "/";
  const ReferenceFile reference = read_reference(folder + mode + ".exr", PathTracerOptions::Light::full);
  const Metrics m =
      measure(reference.color, picture.color, &*reference.noise, region_mask(Region::noedge, *reference.layers));
  ASSERT_TRUE(m.relative && m.relative->blk_pct);
  // Of metal, the masking of the other renderer is another one.
  EXPECT_LT(*m.relative->blk_pct, metal ? 4.0 : 2.0);
  EXPECT_NEAR(m.relative->ratio, 1.0, metal ? 0.03 : 0.01);
  EXPECT_EQ(m.nonfinite + m.negative, 0);
  RecordProperty("blk_percent", std::to_string(*m.relative->blk_pct));
  RecordProperty("energy", std::to_string(m.relative->ratio));
  if (scene_name == "thin_wall")
    for (size_t i = 0; i < picture.color.pixels.size(); ++i)
      if (picture.id[i] > 0 && picture.position.pixels[i].x > 0.011f) {
        ASSERT_EQ(picture.color.pixels[i], glm::vec3(0.0f)) << "light behind the wall, pixel " << i;
      }
}

INSTANTIATE_TEST_SUITE_P(Renderings, Independent,
                         testing::Combine(testing::Values("cornell", "room", "thin_wall", "sky_court", "area_tv",
                                                          "metal_box"),
                                          testing::Values("direct", "one", "full")),
                         [](const auto& test) { return std::get<0>(test.param) + "_" + std::get<1>(test.param); });

// The auxiliary layers are those that regions are made from.
TEST(Independent, LayersAgree) {
  const Scene scene = load_scene(kData + "scenes/room.glb");
  PathTracerOptions options;
  options.size = {192, 192};
  options.samples_per_pixel = 2;
  options.max_bounces = 0;
  const ReferencePicture picture = path_trace(scene, scene.cameras.at(0), options);
  const RegionLayers theirs = *read_reference(kData + "ref/room/full.exr", PathTracerOptions::Light::full).layers;
  const RegionLayers ours{picture.position, picture.normal, picture.direct, picture.id, picture.depth};
  int inside = 0, close = 0;
  const Mask mask = region_mask(Region::noedge, theirs);
  for (size_t i = 0; i < mask.size(); ++i) {
    if (mask[i] == 0) continue;
    ++inside;
    const glm::vec3 p = theirs.position.pixels[i], n = theirs.normal.pixels[i];
    close += glm::length(picture.position.pixels[i] - p) < 0.01f && glm::dot(picture.normal.pixels[i], n) > 0.999f;
  }
  EXPECT_GT(inside, 30000);
  EXPECT_GT(close, 0.999 * inside);
  const Mask own = region_mask(Region::noedge, ours);
  int same = 0;
  for (size_t i = 0; i < mask.size(); ++i) same += mask[i] == own[i];
  EXPECT_GT(same, 0.97 * static_cast<double>(mask.size()));
}

TEST(Independent, SameLightsReachAPixel) {
  const Scene scene = load_scene(kData + "scenes/metal_box.glb");
  PathTracerOptions options;
  options.size = {192, 192};
  options.samples_per_pixel = 2;
  options.max_bounces = 0;
  const ReferencePicture picture = path_trace(scene, scene.cameras.at(0), options);
  const RegionLayers theirs = *read_reference(kData + "ref/metal_box/full.exr", PathTracerOptions::Light::full).layers;
  ASSERT_EQ(theirs.lit.size(), picture.lit.size());
  int same = 0;
  for (size_t i = 0; i < picture.lit.size(); ++i) same += theirs.lit[i] == picture.lit[i];
  RecordProperty("same", same);
  EXPECT_GT(same, 0.999 * static_cast<double>(picture.lit.size()));
}

}  // namespace
}  // namespace volgi
