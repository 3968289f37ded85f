// Light at subsplats: each form against double, splatting against gathering, a hierarchy against what it ends in, and
// whole frames against every pixel.
#include "screen/gather/subsplats/splat.h"
#include "screen/gather/subsplats/subsplats_stage.h"
#include "screen/gather/subsplats/upsample.h"
#include "screen/lights/patches/light_patches.h"
#include "tests/screen/gather/subsplats/subsplat_scene.h"
#include "tests/support/frame_picture.h"
#include "tests/support/gl_test.h"
#include "tests/support/paths.h"

namespace volgi::test {
namespace {

using screen::LightForm;
using screen::SubsplatRefinement;

/// Over flux: Nichols 2010, eqs. 3.2 (kept from nearing) and 4.1, in double.
double form_of(LightForm form, const VirtualLight& light, glm::dvec3 x, glm::dvec3 normal, glm::dvec3 geometric) {
  const glm::dvec3 w = glm::dvec3(light.position) - x;
  const double squared = glm::dot(w, w), along = glm::dot(w, normal), height = -glm::dot(w, glm::dvec3(light.normal));
  if (std::min({along, glm::dot(w, geometric), height}) <= 0.0) return 0.0;
  const double area = double(light.area_m2), cosines = along * height / squared;
  if (form == LightForm::exact) return disk_to_point_exact(x, normal, light.position, light.normal, area);
  if (form == LightForm::point) return cosines / std::max(glm::pi<double>() * squared, area);
  return cosines / (glm::pi<double>() * squared + area);
}

class SubsplatGatherTest : public GlTest {
 protected:
  static std::vector<VirtualLight> some_lights() {
    return {light_at({0, 2.9f, 0}, {0, -1, 0}, {3, 2, 1}, 0.2f),
            light_at({-1.9f, 0.2f, 0.5f}, {1, 0.1f, 0}, {1, 1, 4}, 0.05f),
            light_at({0.4f, 1.5f, 1.9f}, {0, -0.3f, -1}, {0, 0, 0}, 0.1f),  // dark: not in the cache
            light_at({1.5f, 0.01f, 0.9f}, {0, 1, 0}, {2, 0.5f, 1}, 0.3f)};
  }
};

// At every pixel, levels being one: no mean of pixels is in between.
TEST_F(SubsplatGatherTest, FormsAreThoseOfTheThesis) {
  const Scene scene = stage();
  const Seen seen(context(), scene, stage_camera(scene), {48, 40});
  const SubsplatLevels levels = SubsplatLevels::of(seen.size, 1000, 1);
  ASSERT_EQ(levels.last, 0);
  gl::PassTimer timer(context().software(), false);
  DiscontinuityMipmaps mipmaps(levels, {});
  FlattenedBuffer buffer(levels);
  buffer.mark(seen.gbuffer, mipmaps, timer);
  screen::LightCache cache;
  cache.run(list_of(some_lights()), nullptr, timer);
  for (const LightForm form : {LightForm::point, LightForm::disk, LightForm::exact}) {
    buffer.clear();
    screen::StencilGather(form, 1.0f).run(seen.gbuffer, buffer, cache, {}, timer);
    const std::vector<glm::vec4> got = texels(buffer.irradiance());
    double largest = 0.0, worst = 0.0;
    for (size_t i = 0; i < got.size(); ++i) {
      glm::dvec3 sum(0.0);
      for (const VirtualLight& l : some_lights())
        if (seen.position[i].w != 0.0f)
          sum += glm::dvec3(l.flux) * form_of(form, l, seen.position[i], seen.normal(i), seen.geometric(i));
      largest = std::max({largest, sum.x, sum.y, sum.z});
      const glm::dvec3 d = glm::abs(glm::dvec3(got[i]) - sum);
      worst = std::max({worst, d.x, d.y, d.z});
    }
    EXPECT_LT(worst, 2e-5 * largest) << int(form);
  }
}

// The same fragments and lights: only the order of rounding differs, 1024 lights of 2^-24 each.
TEST_F(SubsplatGatherTest, SplattingGivesWhatGatheringDoes) {
  const Scene scene = stage();
  const Seen seen(context(), scene, stage_camera(scene), {80, 60});
  const SubsplatLevels levels = SubsplatLevels::of(seen.size, 8, 1);
  gl::PassTimer timer(context().software(), false);
  DiscontinuityMipmaps mipmaps(levels, {});
  mipmaps.run(seen.gbuffer, seen.camera, seen.diagonal_m, timer);
  std::vector<VirtualLight> lights;  // more than a block of them
  for (int i = 0; i < 1200; ++i) {
    const float t = float(i) / 1200.0f;
    lights.push_back(light_at({1.9f * std::sin(40.0f * t), 2.9f - t, 1.9f * std::cos(31.0f * t)}, {0.1f, -1, 0.2f * t},
                              {1.0f, 1.0f - t, t}, 0.02f));
    if (i % 7 == 0) lights.back().flux = glm::vec3(0.0f);
  }
  screen::LightCache cache;
  cache.run(list_of(lights), nullptr, timer);
  FlattenedBuffer gathered(levels), splatted(levels);
  gathered.clear();
  gathered.mark(seen.gbuffer, mipmaps, timer);
  screen::StencilGather(LightForm::disk, 1.0f).run(seen.gbuffer, gathered, cache, {}, timer);
  const std::vector<glm::vec4> expected = texels(gathered.irradiance());
  for (const auto by : {SubsplatRefinement::By::geometry, SubsplatRefinement::By::compute}) {
    SubsplatRefinement subsplats(levels, by, SubsplatRefinement::For::all_lights, LightForm::disk);
    subsplats.begin_frame();
    subsplats.run(seen.gbuffer, mipmaps, timer);
    splatted.clear();
    screen::Splat(LightForm::disk).run(seen.gbuffer, splatted, cache, subsplats, {}, timer);
    EXPECT_EQ(lit_set(splatted), lit_set(gathered));
    const std::vector<glm::vec4> got = texels(splatted.irradiance());
    for (size_t i = 0; i < got.size(); ++i) {
      for (int c = 0; c < 3; ++c) ASSERT_NEAR(got[i][c], expected[i][c], 1e-4f * expected[i][c] + 1e-7f);
    }
  }
}

double rmse(const Image& reference, const Image& image) {
  double squared = 0.0, mean = 0.0;
  for (size_t i = 0; i < reference.pixels.size(); ++i) {
    const glm::dvec3 d(image.pixels[i] - reference.pixels[i]);
    squared += glm::dot(d, d) / 3.0;
    mean += glm::dot(glm::dvec3(reference.pixels[i]), glm::dvec3(1.0 / 3.0));
  }
  const double count = double(reference.pixels.size());
  return std::sqrt(squared / count) / (mean / count);
}

struct Setting {
  const char* name;
  const char* value;
};
Rendered picture(const gl::Context& context, const Scene& scene, Gi gi, int size, std::initializer_list<Setting> set) {
  screen::FrameOptions o = picture_options(gi, glm::ivec2(size), screen::LightPart::indirect);
  o.bounces = 1;
  for (const Setting& s : set) screen::set_parameter(o.settings, std::string(s.name) + "=" + s.value);
  return render(context, scene, scene.cameras.at(0), o);
}
Scene scene_of(const char* name) { return load_scene(source_dir() / "data" / (std::string(name) + ".glb")); }

// Same lights: the thesis has 2 to 3 %, the table asks for 1.5 %.
TEST_F(SubsplatGatherTest, AFrameIsThatOfEveryPixel) {
  for (const char* name : {"cornell", "room"}) {
    const Scene scene = scene_of(name);
    const Rendered every = picture(context(), scene, "multires", 160, {{"multires.cells", "16384"}});
    const Rendered some = picture(context(), scene, "multires", 160, {});
    const double error = rmse(every.image, some.image);
    RecordProperty(name, std::to_string(error));
    EXPECT_LT(error, 0.015) << name;
    EXPECT_LT(some.report.number("fragments"), 0.8 * every.report.number("fragments")) << name;
  }
}

TEST_F(SubsplatGatherTest, SplattedFramesAreGatheredFrames) {
  const Scene scene = scene_of("cornell");
  const Rendered gathered = picture(context(), scene, "multires", 96, {});
  for (const char* by : {"geometry", "compute"}) {
    const Rendered splatted =
        picture(context(), scene, "multires", 96, {{"multires.sum", "splat"}, {"multires.refine", by}});
    EXPECT_LT(rmse(gathered.image, splatted.image), 1e-5) << by;
    EXPECT_EQ(gathered.report.number("fragments"), splatted.report.number("fragments")) << by;
  }
}

// Subsplats for each light: T towards 0 is every pixel, where quadrants are pixels. From coarser levels on, what none
// of the quadrants' middles shows stays hidden, as the thesis says of sharp highlights (§3.2.3.1).
TEST_F(SubsplatGatherTest, LightsWithTheirOwnSubsplatsConverge) {
  const Scene scene = scene_of("cornell");
  const auto of = [&](const char* difference, const char* cells) {
    return picture(context(), scene, "multires", 64,
                   {{"multires.sum", "splat"},
                    {"multires.each_light", "on"},
                    {"multires.difference", difference},
                    {"patches.grid", "8"},
                    {"multires.refine", "compute"},
                    {"multires.cells", cells}});
  };
  const Rendered every =
      picture(context(), scene, "multires", 64, {{"multires.cells", "16384"}, {"patches.grid", "8"}});
  const Rendered coarse = of("1e-2", "32"), middle = of("1e-4", "32"), fine = of("0", "32");
  EXPECT_LT(rmse(every.image, middle.image), 0.5 * rmse(every.image, coarse.image));
  EXPECT_LT(rmse(every.image, fine.image), 1e-5);
  EXPECT_LT(coarse.report.number("fragments"), middle.report.number("fragments"));
  EXPECT_LT(middle.report.number("fragments"), fine.report.number("fragments"));
  EXPECT_LT(rmse(every.image, of("0", "16").image), 0.05);
}

// tau = 1 divides nothing, a small one everything: roots, and patches of the last depth.
TEST_F(SubsplatGatherTest, AHierarchyEndsInItsRootsAndItsLeaves) {
  const Scene scene = scene_of("cornell");
  const Rendered roots = picture(context(), scene, "multires", 64, {{"patches.grid", "8"}});
  const Rendered leaves = picture(context(), scene, "multires", 64, {{"patches.grid", "32"}});
  const auto of = [&](const char* threshold) {
    return picture(context(), scene, "hierarchical", 64,
                   {{"patches.grid", "8"}, {"patches.depth", "2"}, {"multires.threshold", threshold}});
  };
  EXPECT_LT(rmse(roots.image, of("1").image), 1e-5);
  EXPECT_LT(rmse(leaves.image, of("1e-4").image), 1e-5);
  const double some = rmse(leaves.image, of("0.1").image), none = rmse(leaves.image, roots.image);
  EXPECT_LT(some, none);
  // What shows several surfaces is divided from any distance, and what does not may be summed.
  const auto summed = [&](Gi gi, std::initializer_list<Setting> more) {
    std::vector<Setting> all{{"patches.light", "summed"}, {"patches.depth", "2"}};
    all.insert(all.end(), more.begin(), more.end());
    screen::FrameOptions o = picture_options(gi, glm::ivec2(64), screen::LightPart::indirect);
    o.bounces = 1;
    for (const Setting& s : all) screen::set_parameter(o.settings, std::string(s.name) + "=" + s.value);
    return render(context(), scene, scene.cameras.at(0), o).image;
  };
  const Image every = summed("multires", {{"patches.grid", "32"}});
  const Image apart = summed("hierarchical", {{"patches.grid", "8"}, {"patches.edges", "on"}});
  const Image together = summed("hierarchical", {{"patches.grid", "8"}});
  EXPECT_LT(rmse(every, apart), 0.5 * rmse(every, together));
}

/// A rough mirror and a matt wall, lit from the floor.
Scene shining_stage() {
  Scene scene = stage();
  const int metal = add_material(scene, {0.9f, 0.6f, 0.3f});
  scene.materials[size_t(metal)].metallic_factor = 1.0f;
  scene.materials[size_t(metal)].roughness_factor = 0.3f;
  add_sphere(scene, metal, {-0.6f, 0.6f, 0.9f}, 0.6f, 24);
  update_bounds(scene);
  return scene;
}

// Eq. 3.2 with any BRDF, in double by the formulas of glTF 2.0, appendix B.
TEST_F(SubsplatGatherTest, SurfacesShineAsTheirMaterialsDo) {
  const Scene scene = shining_stage();
  const Camera camera = stage_camera(scene);
  const glm::ivec2 size(64, 56);
  gl::PassTimer timer(context().software(), false);
  const gl::SceneBuffers buffers(scene);
  screen::GBuffer gbuffer(size, GL_RGBA16_SNORM, true);
  gbuffer.run(buffers, camera, timer);
  const SubsplatLevels levels = SubsplatLevels::of(size, 1000, 1);
  DiscontinuityMipmaps mipmaps(levels, {});
  FlattenedBuffer buffer(levels);
  buffer.clear();
  buffer.mark(gbuffer, mipmaps, timer);
  screen::LightCache cache;
  cache.run(list_of(some_lights()), nullptr, timer);
  screen::StencilGather(LightForm::disk, 1.0f)
      .run(screen::SubsplatReceivers(gbuffer, camera), buffer, cache, {}, timer);
  const std::vector<glm::vec4> got = texels(buffer.irradiance()), positions = texels(gbuffer.position()),
                               normals = texels(gbuffer.normals()), albedo = texels(gbuffer.albedo()),
                               diffuse = texels(gbuffer.diffuse()), mirror = texels(gbuffer.mirror());
  const glm::dvec3 eye(camera.world_from_camera[3]);
  double largest = 0.0, worst = 0.0;
  for (size_t i = 0; i < got.size(); ++i) {
    if (positions[i].w == 0.0f) continue;
    const glm::dvec3 x(positions[i]), n = Seen::decoded({normals[i].x, normals[i].y}),
                                      g = Seen::decoded({normals[i].z, normals[i].w}), v = glm::normalize(eye - x);
    glm::dvec3 sum(0.0);
    for (const VirtualLight& l : some_lights()) {
      const glm::dvec3 to = glm::normalize(glm::dvec3(l.position) - x), h = glm::normalize(v + to);
      const double form = form_of(LightForm::disk, l, x, n, g);
      if (!(form > 0.0)) continue;
      // GGX, height-correlated masking after Smith, Schlick.
      const double nl = glm::dot(n, to), nv = std::max(glm::dot(n, v), 1e-4), nh = glm::dot(n, h);
      const double alpha = std::max(std::pow(double(diffuse[i].w), 2.0), 1e-3), a2 = alpha * alpha;
      const double lobe = nh * nh * (a2 - 1.0) + 1.0, d = a2 / (glm::pi<double>() * lobe * lobe);
      const double masking =
          0.5 / (nl * std::sqrt(nv * nv * (1.0 - a2) + a2) + nv * std::sqrt(nl * nl * (1.0 - a2) + a2));
      const double grazing = std::pow(1.0 - glm::dot(v, h), 5.0);
      const glm::dvec3 at_0(mirror[i]), fresnel = at_0 + (double(mirror[i].w) - at_0) * grazing;
      const double left = 1.0 - std::max({fresnel.x, fresnel.y, fresnel.z});
      const glm::dvec3 brdf = glm::dvec3(diffuse[i]) * left / glm::pi<double>() + fresnel * d * masking;
      sum += glm::dvec3(l.flux) * form * brdf;  // radiance
    }
    const glm::dvec3 radiance = glm::dvec3(got[i]) * glm::dvec3(albedo[i]) / glm::pi<double>();
    largest = std::max({largest, sum.x, sum.y, sum.z});
    const glm::dvec3 error = glm::abs(radiance - sum);
    worst = std::max({worst, error.x, error.y, error.z});
  }
  EXPECT_LT(worst, 1e-4 * largest);
}

// §3.2.3.1: by discontinuities alone a highlight on a smooth surface is missed, by illumination it is found.
TEST_F(SubsplatGatherTest, IlluminationFindsHighlights) {
  Scene scene = shining_stage();
  scene.lights = {spot_light({0.0f, 2.5f, 1.5f}, {0.0f, -1.0f, -0.5f}, 20.0f, 40.0f, 30.0f)};
  scene.cameras = {stage_camera(scene)};
  const auto of = [&](std::initializer_list<Setting> set) {
    screen::FrameOptions o = picture_options("multires", glm::ivec2(64), screen::LightPart::indirect);
    o.bounces = 1;
    o.of<screen::SubsplatOptions>().shine = true;
    for (const Setting& s : set) screen::set_parameter(o.settings, std::string(s.name) + "=" + s.value);
    return render(context(), scene, scene.cameras[0], o).image;
  };
  const Image every = of({{"multires.cells", "16384"}, {"patches.grid", "8"}});
  // The sphere's normals do not divide it here: thresholds as high as they go.
  const std::initializer_list<Setting> blind = {
      {"patches.grid", "8"}, {"multires.criterion", "depth"}, {"multires.depth", "10"}};
  const std::initializer_list<Setting> seeing = {
      {"patches.grid", "8"}, {"multires.sum", "splat"}, {"multires.each_light", "on"}, {"multires.difference", "1e-4"}};
  EXPECT_LT(rmse(every, of(seeing)), 0.5 * rmse(every, of(blind)));
}

// With a visibility of ours less light arrives, and never less than none.
TEST_F(SubsplatGatherTest, EveryRecipeTakesOurVisibility) {
  const Scene scene = scene_of("cornell");
  const auto mean = [](const Image& image) {
    double sum = 0.0;
    for (const glm::vec3& p : image.pixels) {
      EXPECT_TRUE(glm::all(glm::greaterThanEqual(p, glm::vec3(0.0f))));
      sum += double(p.x + p.y + p.z);
    }
    return sum;
  };
  for (const Gi gi : {Gi("multires"), Gi("radiosity"), Gi("hierarchical")}) {
    const double open = mean(picture(context(), scene, gi, 48, {}).image);
    for (const char* visibility : {"negative", "area_maps"}) {
      const double seen = mean(picture(context(), scene, gi, 48, {{"multires.visibility", visibility}}).image);
      EXPECT_LT(seen, 0.97 * open) << gi << ' ' << visibility;
      EXPECT_GT(seen, 0.4 * open) << gi << ' ' << visibility;
    }
  }
  const double gathered = mean(picture(context(), scene, "multires", 48, {{"multires.visibility", "area_maps"}}).image);
  const double splatted =
      mean(picture(context(), scene, "multires", 48, {{"multires.visibility", "area_maps"}, {"multires.sum", "splat"}})
               .image);
  EXPECT_NEAR(splatted / gathered, 1.0, 1e-4);
}

TEST_F(SubsplatGatherTest, RefusesWhatDoesNotGoTogether) {
  const Scene scene = scene_of("cornell");
  EXPECT_THROW(picture(context(), scene, "hierarchical", 16, {{"multires.sum", "splat"}}), Error);
  EXPECT_THROW(picture(context(), scene, "multires", 16, {{"multires.each_light", "on"}}), Error);
  EXPECT_THROW(picture(context(), scene, "multires", 16, {{"multires.finest", "3"}}), Error);
  EXPECT_THROW(picture(context(), scene, "multires", 16, {{"patches.grid", "12"}}), Error);
  EXPECT_THROW(picture(context(), scene, "multires", 16, {{"patches.grid", "128"}, {"shadow.spot", "64"}}), Error);
}

}  // namespace
}  // namespace volgi::test
