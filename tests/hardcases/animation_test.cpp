// Geometry that moves: a frame that has followed its scene shows what a new one would, in every technique.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include "core/metaballs.h"
#include "core/scene_source.h"
#include "tests/support/frame_picture.h"
#include "tests/support/gl_test.h"
#include "tests/support/gltf_writer.h"
#include "tests/support/volume_scenes.h"

namespace volgi::test {
namespace {

/// A frame that lives on while its scene changes.
class Followed {
 public:
  Followed(const gl::Context& context, const Scene& scene, const screen::FrameOptions& options)
      : scene_(scene), timer_(context.software(), false), frame_(scene, options) {}

  Image render() {
    frame_.render(scene_.cameras.at(0), timer_);
    return screen::image_from_texture(frame_.radiance());
  }
  Image follow() {
    frame_.follow_scene(timer_);
    return render();
  }
  screen::FrameReport report() const { return frame_.report(); }

 private:
  const Scene& scene_;
  gl::PassTimer timer_;
  screen::Frame frame_;
};

bool same_bytes(const Image& a, const Image& b) {
  return a.pixels.size() == b.pixels.size() &&
         std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(glm::vec3)) == 0;
}

class Animation : public GlTest {
 protected:
  static screen::FrameOptions options(Gi gi, Scheme scheme = Scheme::ordinates) {
    screen::FrameOptions o;
    o.recipe = gi;
    o.size = {40, 40};
    o.backend = tested_backend();
    o.of<VolumeOptions>().grid_cells = 12;
    o.of<VolumeOptions>().scheme.scheme = scheme;
    o.of<VolumeOptions>().scheme.directions = 24;
    o.of<screen::ReflectiveShadowMap::Resolution>() = {128, 64, 128};
    o.of<screen::VirtualLightOptions>().count = 64;
    o.of<screen::ResampleOptions>().candidates = 4;
    o.of<screen::NegativeLightOptions>().count = 32;
    o.of<screen::VirtualAreaLightOptions>().count = 8;
    o.of<screen::AreaMapOptions>().texels = 64;
    return o;
  }

  struct Technique {
    std::string name;
    screen::FrameOptions options;
  };
  static std::vector<Technique> techniques() {
    return {{"none", options(Gi("none"))},
            {"vpl", options(Gi("vpl"))},
            {"negative", options(Gi("negative"))},
            {"val", options(Gi("val"))},
            {"hybrid", options(Gi("hybrid"))},
            {"hybrid, conservative", options(Gi("hybrid"), Scheme::conservative)},
            {"volume, ordinates", options(Gi("volume"))},
            {"volume, conservative", options(Gi("volume"), Scheme::conservative)},
            {"volume, gaitatzes2010", options(Gi("volume"), Scheme::gaitatzes2010)}};
  }

  static Image fresh(const Scene& scene, const screen::FrameOptions& o) {
    return Followed(context(), scene, o).render();
  }

  /// In the techniques whose names have one of `among` in them: `scene` as it is, then as `change` leaves it.
  template <typename F>
  static void expect_followed(const Scene& scene, const F& change, const std::vector<std::string>& among) {
    for (const Technique& technique : techniques()) {
      const auto named = [&](const std::string& part) { return technique.name.find(part) != std::string::npos; };
      if (std::none_of(among.begin(), among.end(), named)) continue;
      Scene moving = scene;
      Followed followed(context(), moving, technique.options);
      const Image before = followed.render();
      change(moving);
      const Image after = followed.follow();
      EXPECT_TRUE(same_bytes(after, fresh(moving, technique.options))) << technique.name;
      EXPECT_FALSE(same_bytes(after, before)) << technique.name;
    }
  }
};

TEST_F(Animation, FollowsMetaballs) {
  expect_followed(load_scene("builtin:metaballs", 0.0), [](Scene& scene) { move_metaballs(scene, 1.7); }, {""});
}

// Without looking again, voxelization has room for a fifth more sides.
TEST_F(Animation, FindsRoomForWhatGrows) {
  const Scene full = load_scene("builtin:metaballs", 0.5);
  Scene small = full;
  for (glm::vec3& p : small.meshes.back().positions) p *= 0.02f;
  const auto sides = [](const Scene& scene) {
    Followed followed(context(), scene, options(Gi("volume")));
    followed.render();
    return double(followed.report().of<screen::VolumeReport>().sides);
  };
  EXPECT_GT(sides(full), 1.25 * sides(small));
  expect_followed(small, [](Scene& s) { move_metaballs(s, 0.5); }, {"negative", "volume, ordinates"});
}

// What the bounds decide follows as well: the grid, a sun's map.
TEST_F(Animation, FollowsBounds) {
  Scene scene = load_scene("builtin:metaballs", 0.5);
  scene.lights.push_back(sun_light(glm::normalize(glm::vec3(0.3f, -0.5f, -1.0f)), glm::vec3(1.0f)));
  expect_followed(scene,
                  [](Scene& s) {
                    for (glm::vec3& p : s.meshes.back().positions) p.z += 1.0f;
                    update_bounds(s);
                  },
                  {"none", "negative", "hybrid", "volume, ordinates", "volume, gaitatzes2010"});
}

/// The metaballs' room with an emissive square as its last mesh.
Scene with_emitter() {
  Scene scene = load_scene("builtin:metaballs", 0.5);
  const int lamp = add_material(scene, glm::vec3(0.2f), glm::vec3(4.0f, 3.0f, 2.0f));
  add_quad(scene, lamp, {-0.9f, -0.5f, 0.0f}, {0.5f, 0.0f, 0.2f}, {0.0f, 0.5f, 0.1f});
  return scene;
}

TEST_F(Animation, FollowsLampsCamerasAndEmission) {
  expect_followed(with_emitter(),
                  [](Scene& s) {
                    for (glm::vec3& p : s.meshes.back().positions) p += glm::vec3(1.0f, -0.1f, 0.1f);
                    s.lights[0].position.x = 0.3f;
                    s.cameras[0].world_from_camera[3].x += 0.1f;
                  },
                  {"vpl", "val", "hybrid", "volume, ordinates", "volume, conservative"});
}

// An emitter of no size is left out of a scene, and comes back: what carries its light goes and comes with it.
TEST_F(Animation, FollowsEmittersThatGo) {
  expect_followed(with_emitter(), [](Scene& s) { s.meshes.pop_back(); }, {"vpl", "val", "hybrid", "volume, ordinates"});
}

TEST_F(Animation, FollowsEmittersThatCome) {
  Scene scene = with_emitter();
  const Mesh emitter = scene.meshes.back();
  scene.meshes.pop_back();
  scene.lights.clear();
  expect_followed(scene, [&](Scene& s) { s.meshes.push_back(emitter); }, {"vpl", "hybrid", "volume, ordinates"});
}

/// A floor of 4 m and a plate 1 m above it, which its node carries from x = -1 to x = 1 in two seconds.
GltfWriter moving_plate() {
  GltfWriter writer;
  const auto quad = [&](float half, const Json& node) {
    const std::vector<float> corners = {-half, 0, half, half, 0, half, half, 0, -half, -half, 0, -half};
    const int positions = writer.floats(corners, "VEC3");
    const int indices = writer.accessor(std::vector<std::uint16_t>{0, 1, 2, 0, 2, 3}, "SCALAR", type_ushort);
    return writer.mesh_node({{"attributes", {{"POSITION", positions}}}, {"indices", indices}, {"material", 0}}, node);
  };
  writer.push("materials", {{"pbrMetallicRoughness", {{"metallicFactor", 0.0}}}});
  quad(2.0f, Json::object());
  const int plate = quad(0.25f, {{"translation", {-1.0, 1.0, 0.0}}});
  const Json sampler = {{"input", writer.floats({0, 2}, "SCALAR")},
                        {"output", writer.floats({-1, 1, 0, 1, 1, 0}, "VEC3")}};
  const Json channel = {{"sampler", 0}, {"target", {{"node", plate}, {"path", "translation"}}}};
  writer.push("animations", {{"samplers", Json::array({sampler})}, {"channels", Json::array({channel})}});
  return writer;
}

/// Its lamp, 3 m above the floor, casts the plate's shadow to x = -1.5, z = -0.75 at first; its camera looks down.
void light_plate(Scene& scene) {
  const auto centred = [&](double x, double y, double z) {
    return glm::vec3(glm::dvec3(x, y, z) - scene.world_origin);
  };
  scene.lights = {point_light(centred(0.0, 3.0, 1.5), glm::vec3(10.0f))};
  scene.cameras = {
      look_at_camera(centred(0.0, 5.0, 0.5), centred(0.0, 0.0, 0.0), 1.0f, scene.bounds_min, scene.bounds_max)};
}

/// The picture at a point of the file's frame.
float red_at(const Image& image, const Scene& scene, glm::dvec3 point) {
  const Camera& camera = scene.cameras.at(0);
  const glm::vec4 clip = clip_from_camera(camera, {image.width, image.height}) * camera_from_world(camera) *
                         glm::vec4(glm::vec3(point - scene.world_origin), 1.0f);
  const glm::vec2 part = 0.5f + glm::vec2(0.5f, -0.5f) * glm::vec2(clip) / clip.w;
  return image.at(int(part.x * float(image.width)), int(part.y * float(image.height))).x;
}

TEST_F(Animation, AnimatedNodesMoveInThePictureWithTheirShadows) {
  const TemporaryFolder folder;
  const std::filesystem::path file = moving_plate().save_glb(folder / "plate.glb");
  const SceneSource source(file);
  WorldBox box;
  for (const double time_s : {0.0, 1.0, 2.0}) box.add(source.bounds(time_s));
  Scene scene = source.at(0.0, box);
  light_plate(scene);
  Followed followed(context(), scene, options(Gi("none")));
  const Image first = followed.render();
  source.move(scene, 2.0, box);
  light_plate(scene);
  const Image last = followed.follow();

  const glm::dvec3 first_shadow(-1.5, 0.0, -0.75), last_shadow(1.5, 0.0, -0.75);
  EXPECT_EQ(red_at(first, scene, first_shadow), 0.0f);
  EXPECT_GT(red_at(last, scene, first_shadow), 0.1f);
  EXPECT_EQ(red_at(last, scene, last_shadow), 0.0f);
  EXPECT_GT(red_at(first, scene, last_shadow), 0.1f);
  const glm::dvec3 first_plate(-1.0, 1.0, 0.0), last_plate(1.0, 1.0, 0.0);  // nearer to the lamp than what is below
  EXPECT_GT(red_at(first, scene, first_plate), 1.3f * red_at(last, scene, first_plate));
  EXPECT_GT(red_at(last, scene, last_plate), 1.3f * red_at(first, scene, last_plate));
}

// Where the bounds stand still, a frame of an animation is the picture of its time alone; else it has the animation's
// bounds, and the grid of all frames.
TEST_F(Animation, FramesAreThePicturesOfTheirTimes) {
  const TemporaryFolder folder;
  GltfWriter writer = moving_plate();
  const std::filesystem::path still_bounds = writer.save_glb(folder / "plate.glb");
  writer.root["nodes"][0]["scale"] = {0.5, 1.0, 0.5};  // the plate leaves the floor
  const std::filesystem::path moving_bounds = writer.save_glb(folder / "leaves.glb");
  const screen::FrameOptions o = options(Gi("volume"));
  for (const bool still : {true, false}) {
    const SceneSource source(still ? still_bounds : moving_bounds);
    WorldBox box;
    for (const double time_s : {0.0, 0.5, 2.0}) box.add(source.bounds(time_s));
    Scene scene = source.at(0.0, box);
    light_plate(scene);
    Followed followed(context(), scene, o);
    const Image first = followed.render();
    const glm::ivec3 grid = followed.report().of<screen::VolumeReport>().grid;
    source.move(scene, 0.5, box);
    light_plate(scene);
    const Image moved = followed.follow();
    EXPECT_EQ(followed.report().of<screen::VolumeReport>().grid, grid);
    EXPECT_FALSE(same_bytes(moved, first));
    Scene alone = load_scene(still ? still_bounds : moving_bounds, 0.5);
    light_plate(alone);
    EXPECT_EQ(same_bytes(moved, fresh(alone, o)), still);
    EXPECT_TRUE(same_bytes(moved, fresh(scene, o)));
  }
}

}  // namespace
}  // namespace volgi::test
