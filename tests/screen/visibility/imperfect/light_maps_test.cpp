// Maps of virtual lights: which lights have one, and how far their shadows are from exact ones.
#include "screen/visibility/imperfect/light_maps.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "core/visibility/embree_scene.h"
#include "reference/metrics.h"
#include "reference/virtual_light_tracer.h"
#include "screen/frame/frame.h"
#include "screen/lights/lattice/wave_lattice.h"
#include "shaders/screen/visibility/imperfect/light_map.shared.h"
#include "tests/screen/gathered.h"
#include "tests/support/frame_picture.h"
#include "tests/support/gl_test.h"
#include "tests/support/invariance.h"
#include "tests/support/paths.h"

namespace volgi::test {
namespace {

using screen::FrameOptions;
using screen::ImperfectMapOptions;
using screen::LightPart;
using screen::VisibilityChoice;

TEST(LightMap, EvenlySpreadAndFoundAgain) {
  for (const auto& [lights, mapped] :
       {std::pair(1024, 1024), {1024, 256}, {6485, 512}, {7, 3}, {5, 5}, {65536, 1024}}) {
    int with_maps = 0, last = -1, longest = 0;
    for (int i = 0; i < lights; ++i) {
      const int map = shared::map_of_light(i, lights, mapped);
      if (map < 0) continue;
      EXPECT_EQ(map, with_maps++);
      EXPECT_EQ(shared::light_of_map(map, lights, mapped), i);
      longest = std::max(longest, i - last);
      last = i;
    }
    EXPECT_EQ(with_maps, mapped);
    EXPECT_LE(longest, (lights + mapped - 1) / mapped);
  }
}

Scene load(const std::string& name) { return load_scene(source_dir() / "data" / (name + ".glb")); }

FrameOptions options_of(VisibilityChoice::Maps maps, int size) {
  FrameOptions o = picture_options("vpl", {size, size}, LightPart::indirect);
  o.of<screen::GatherOptions>().stride = 1;
  o.of<VisibilityChoice>().maps = maps;
  return o;
}

class LightMapsTest : public GlTest {
 protected:
  /// Error of a picture's light against the same lights with exact visibility [%], and its energy.
  static Metrics::Relative against_exact(const Scene& scene, FrameOptions options) {
    screen::Frame frame(scene, options);
    gl::PassTimer timer(context().software(), false);
    frame.render(scene.cameras.at(0), timer);
    VirtualLightGatherOptions exact;
    exact.size = options.size;
    exact.light = PathTracerOptions::Light::indirect;
    const ReferencePicture p = gather_virtual_lights(scene, scene.cameras.at(0), frame.virtual_lights(), exact);
    const RegionLayers layers{p.position, p.normal, p.direct, p.id, p.depth};
    return measure(p.color, screen::image_from_texture(frame.radiance()), nullptr, region_mask(Region::noedge, layers))
        .relative.value();
  }
};

// The limits that were asked for; measured at 192 x 192: 1.7, 2.7 and 10.8 %, 1.1, 1.4 and 9.9 with maps of 64 x 64,
// 18, 22 and 53 without any.
TEST_F(LightMapsTest, ImperfectMapsAgainstExactVisibility) {
  for (const auto& [name, limit] : {std::pair("cornell", 10.0), {"occluder", 6.0}, {"room", 15.0}}) {
    const Metrics::Relative m = against_exact(load(name), options_of(VisibilityChoice::Maps::imperfect, 96));
    RecordProperty(std::string("imperfect_") + name, std::to_string(m.rmse_pct));
    EXPECT_LT(m.rmse_pct, limit) << name;
    EXPECT_NEAR(m.ratio, 1.0, 0.04) << name;
    EXPECT_GT(against_exact(load(name), options_of(VisibilityChoice::Maps::none, 96)).rmse_pct, 1.5 * limit) << name;
  }
}

TEST_F(LightMapsTest, RegularMapsAgainstExactVisibility) {
  for (const auto& [name, limit] : {std::pair("cornell", 0.5), {"occluder", 0.5}}) {
    FrameOptions o = options_of(VisibilityChoice::Maps::regular, 64);
    o.of<screen::VirtualLightOptions>().count = 256;
    EXPECT_LT(against_exact(load(name), o).rmse_pct, limit) << name;
    // Half of the lights without a map: half of the way to no shadows at all.
    FrameOptions without = options_of(VisibilityChoice::Maps::none, 64);
    without.of<screen::VirtualLightOptions>().count = 256;
    const double all = against_exact(load(name), without).rmse_pct;
    o.of<ImperfectMapOptions>().regular_count = 128;
    EXPECT_NEAR(against_exact(load(name), o).rmse_pct / all, 0.5, 0.1) << name;
  }
}

/// What texels of an imperfect map hold is what rays meet, but for those at edges. Where rays meet nothing there are no
/// receivers either.
TEST_F(LightMapsTest, TexelsAgainstRays) {
  const Scene scene = load("cornell");
  const EmbreeScene embree(scene);
  const float diagonal_m = glm::distance(scene.bounds_min, scene.bounds_max);
  const VirtualLight light = light_at({0.2f, 0.9f, 0.1f}, {0.1f, -1.0f, -0.2f});
  screen::VirtualLightListGl list = list_of({light});
  list.in_the_air = true;  // both hemispheres
  gl::PassTimer timer(context().software(), false);
  const gl::SceneBuffers triangles(scene);
  for (const int texels : {16, 32, 64}) {
    ImperfectMapOptions options;
    options.texels = texels;
    screen::LightMaps maps(scene, VisibilityChoice::Maps::imperfect, options);
    maps.run(triangles, list, diagonal_m, timer);
    EXPECT_EQ(maps.maps(), 2);
    std::vector<screen::NamedTexture> textures;
    maps.list_textures(textures);
    const std::vector<float> distances = textures.at(0).texture->download(1);
    const int edge = textures.at(0).texture->size().x;
    int compared = 0, far_off = 0;
    for (int side = 0; side < 2; ++side) {
      const glm::vec3 n = side == 0 ? light.normal : -light.normal;
      const glm::vec3 away = std::abs(n.x) < 0.7f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
      const glm::vec3 right = glm::normalize(away - n * glm::dot(away, n)), up = glm::cross(n, right);
      for (int y = 0; y < texels; ++y) {
        for (int x = 0; x < texels; ++x) {
          const glm::vec2 disk = (glm::vec2(x, y) + 0.5f) * (2.0f / float(texels)) - 1.0f;
          const float found = distances[size_t(y) * size_t(edge) + size_t(side * texels + x)];
          if (glm::dot(disk, disk) > 1.0f) {
            EXPECT_TRUE(std::isinf(found));
            continue;
          }
          const glm::vec3 d = shared::direction_from_paraboloid(disk);
          RayHit hit;
          const bool met =
              embree.intersect(light.position, glm::normalize(d.x * right + d.y * up + d.z * n), 1e9f, 0, hit);
          if (!met) continue;
          ++compared;
          far_off += !(std::abs(found / hit.distance - 1.0f) < 0.02f);
        }
      }
    }
    RecordProperty("texels_" + std::to_string(texels), std::to_string(double(far_off) / compared));
    EXPECT_LT(double(far_off) / compared, 0.07) << texels;
  }
}

TEST_F(LightMapsTest, ClustersOnImperfectMaps) {
  for (const auto& [name, limit] : {std::pair("cornell", 3.5), {"occluder", 3.5}}) {
    const Scene scene = load(name);
    FrameOptions o = picture_options("val", {96, 96}, LightPart::indirect);
    const Image regular = render(context(), scene, scene.cameras.at(0), o).image;
    o.of<VisibilityChoice>().maps = VisibilityChoice::Maps::imperfect;
    o.of<ImperfectMapOptions>().texels = 64;
    const Image imperfect = render(context(), scene, scene.cameras.at(0), o).image;
    const double deviation = rmse_percent(imperfect, regular);
    RecordProperty(std::string("clusters_") + name, std::to_string(deviation));
    EXPECT_LT(deviation, limit) << name;
    EXPECT_GT(deviation, 0.0) << name;
  }
  FrameOptions none = picture_options("val", {16, 16});
  none.of<VisibilityChoice>().maps = VisibilityChoice::Maps::none;
  EXPECT_THROW(render(context(), load("cornell"), load("cornell").cameras.at(0), none), Error);
}

/// Where nothing changes nothing changes; where a scene has moved, its maps see it there.
TEST_F(LightMapsTest, FollowTheScene) {
  Scene scene = load("occluder");
  const Camera camera = scene.cameras.at(0);
  FrameOptions o = options_of(VisibilityChoice::Maps::imperfect, 48);
  o.backend = tested_backend();
  screen::Frame frame(scene, o);
  gl::PassTimer timer(context().software(), false);
  frame.render(camera, timer);
  const Image first = screen::image_from_texture(frame.radiance());
  frame.render(camera, timer);
  EXPECT_EQ(screen::image_from_texture(frame.radiance()).pixels, first.pixels);
  for (Mesh& mesh : scene.meshes) {
    if (mesh.name != "plate") continue;
    for (glm::vec3& p : mesh.positions) p += glm::vec3(0.2f, 0.0f, 0.1f);
  }
  frame.follow_scene(timer);
  frame.render(camera, timer);
  const Image moved = screen::image_from_texture(frame.radiance());
  EXPECT_NE(moved.pixels, first.pixels);
  EXPECT_EQ(moved.pixels, render(context(), scene, camera, o).image.pixels);
}

TEST_F(LightMapsTest, OddSizesAreRefused) {
  FrameOptions o = options_of(VisibilityChoice::Maps::imperfect, 16);
  o.of<ImperfectMapOptions>().texels = 24;
  const Scene scene = load("cornell");
  EXPECT_THROW(render(context(), scene, scene.cameras.at(0), o), Error);
}

}  // namespace
}  // namespace volgi::test
