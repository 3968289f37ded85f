// Long runs: frames that follow a moving scene take no more memory than at half time, make no more OpenGL objects, and
// the last is the same as one that has followed nothing. The suite has some dozens of frames; VOLGI_SOAK_FRAMES=10000
// (./run soak) as many as one likes.
#include <gtest/gtest.h>
#include <malloc.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>

#include "core/gl/objects.h"
#include "core/scene_source.h"
#include "tests/support/frame_picture.h"
#include "tests/support/gl_test.h"
#include "tests/support/gltf_writer.h"
#include "tests/support/invariance.h"

namespace volgi::test {
namespace {

int frame_count() {
  const char* text = std::getenv("VOLGI_SOAK_FRAMES");
  return text != nullptr ? std::max(8, std::atoi(text)) : 24;
}

/// Of this process, in bytes, what the allocator keeps for later given back first.
std::int64_t resident_bytes() {
  malloc_trim(0);
  std::int64_t size = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> size >> resident;
  return resident * sysconf(_SC_PAGESIZE);
}

constexpr double PERIOD_S = 8.0;  // of both scenes

class Soak : public GlTest, public testing::WithParamInterface<const char*> {
 protected:
  screen::FrameOptions options() const {
    screen::FrameOptions o = picture_options(GetParam(), {24, 24});
    o.of<VolumeOptions>().grid_cells = 8;
    o.of<VolumeOptions>().scheme.directions = 8;
    o.of<screen::ReflectiveShadowMap::Resolution>() = {64, 32, 64};
    o.of<screen::VirtualLightOptions>().count = 64;
    o.of<screen::VirtualAreaLightOptions>().count = 4;
    o.of<screen::AreaMapOptions>().texels = 32;
    return o;
  }

  void follow(const SceneSource& source) const {
    const int frames = frame_count();
    constexpr double fps = 25.0;
    const WorldBox box = source.whole_bounds();
    Scene scene = source.at(0.0, box);
    screen::Frame frame(scene, options());
    gl::PassTimer timer(context().software(), false);
    std::int64_t half_time = 0;
    std::uint64_t objects = 0;
    for (int k = 0; k < frames; ++k) {
      source.move(scene, std::fmod(k / fps, PERIOD_S), box);
      timer.begin_frame();
      frame.follow_scene(timer);
      frame.render(scene.cameras.at(0), timer);
      timer.end_frame();
      if (k == frames / 2) half_time = resident_bytes(), objects = gl::objects_made();
    }
    const std::int64_t grown = resident_bytes() - half_time;
    RecordProperty("frames", frames);
    RecordProperty("grown_bytes", std::to_string(grown));
    constexpr std::int64_t noise = 1 << 20;
    EXPECT_LT(grown, noise) << "in " << frames - frames / 2 << " frames";
    // Buffers grow with their scene until all of it has been seen once. What shines makes a view of the cells anew for
    // each scene that it follows (FaceWalkCells::forget).
    const std::uint64_t made = gl::objects_made() - objects;
    RecordProperty("objects_made", std::to_string(made));
    if (frames / 2 > int(PERIOD_S * fps)) {
      EXPECT_LE(made, std::uint64_t(frames - frames / 2)) << "OpenGL objects after half of the frames";
    }
    const Image last = screen::image_from_texture(frame.radiance());
    EXPECT_GT(mean_light(last), 0.0);
    const Image cold = render(context(), scene, scene.cameras.at(0), options()).image;
    EXPECT_TRUE(last.pixels == cold.pixels) << "frame " << frames - 1 << " is not what a new one shows";
  }

  /// A strip between two joints, of which one turns.
  static std::filesystem::path skinned(const TemporaryFolder& folder) {
    GltfWriter w;
    std::vector<float> positions, weights;
    std::vector<std::uint16_t> joints;
    std::vector<std::uint32_t> indices;
    for (std::uint32_t row = 0; row <= 8; ++row) {
      const float y = 0.25f * float(row);
      for (const float x : {-0.3f, 0.3f}) {
        positions.insert(positions.end(), {x, y, 0.0f});
        weights.insert(weights.end(), {1.0f - float(row) / 8.0f, float(row) / 8.0f, 0.0f, 0.0f});
        joints.insert(joints.end(), {0, 1, 0, 0});
      }
      const std::uint32_t at = 2 * row;
      if (row < 8) indices.insert(indices.end(), {at, at + 1, at + 2, at + 2, at + 1, at + 3});
    }
    const Json attributes = {{"POSITION", w.floats(positions, "VEC3")},
                             {"WEIGHTS_0", w.floats(weights, "VEC4")},
                             {"JOINTS_0", w.accessor(joints, "VEC4", type_ushort)}};
    w.push("materials", {{"pbrMetallicRoughness", {{"metallicFactor", 0.0}}}});
    const int node = w.mesh_node(
        {{"attributes", attributes}, {"material", 0}, {"indices", w.accessor(indices, "SCALAR", type_uint)}});
    const int lower = w.push("nodes", {{"children", {node + 2}}}),
              upper = w.push("nodes", {{"translation", {0, 1, 0}}});
    for (const int root : {node, lower}) w.root["scenes"][0]["nodes"].push_back(root);
    const std::vector<float> bind{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0,  0, 1,
                                  1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 1};
    const int matrices = w.push(
        "accessors", {{"bufferView", w.view(bind)}, {"componentType", type_float}, {"count", 2}, {"type", "MAT4"}});
    w.push("skins", {{"joints", {lower, upper}}, {"inverseBindMatrices", matrices}});
    w.root["nodes"][size_t(node)]["skin"] = 0;
    const int times = w.floats({0.0f, 4.0f, 8.0f}, "SCALAR");
    const int turns = w.floats({0, 0, 0, 1, 0, 0, 0.5f, 0.8660254f, 0, 0, 0, 1}, "VEC4");
    w.push("animations", {{"samplers", {{{"input", times}, {"output", turns}}}},
                          {"channels", {{{"sampler", 0}, {"target", {{"node", upper}, {"path", "rotation"}}}}}}});
    w.root["extensionsUsed"] = {"KHR_lights_punctual"};
    w.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"intensity", 40.0}}};
    const int lamp =
        w.push("nodes", {{"translation", {0.5, 1.5, 1.5}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    w.root["scenes"][0]["nodes"].push_back(lamp);
    w.push("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 1.0}, {"znear", 0.1}}}});
    const int camera = w.push("nodes", {{"camera", 0}, {"translation", {0, 1, 3}}});
    w.root["scenes"][0]["nodes"].push_back(camera);
    return w.save_glb(folder / "skinned.glb");
  }
};

TEST_P(Soak, Metaballs) { follow(SceneSource("builtin:metaballs")); }

TEST_P(Soak, Skin) {
  const TemporaryFolder folder;
  follow(SceneSource(skinned(folder)));
}

INSTANTIATE_TEST_SUITE_P(Recipes, Soak, testing::Values("hybrid", "volume"),
                         [](const auto& test) { return std::string(test.param); });

}  // namespace
}  // namespace volgi::test
