// What must not change the picture: the unit of length, where the scene lies, the strength of its lights.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <vector>

#include "tests/support/frame_picture.h"
#include "tests/support/gl_test.h"
#include "tests/support/volume_scenes.h"

namespace volgi::test {
namespace {

namespace fs = std::filesystem;
const fs::path kData = fs::path(VOLGI_SOURCE_DIR) / "data";

double rmse_percent(const Image& test, const Image& ref, double factor = 1.0) {
  double squares = 0.0, mean = 0.0;
  for (size_t i = 0; i < ref.pixels.size(); ++i) {
    for (int band = 0; band < 3; ++band) {
      const double d = double(test.pixels[i][band]) / factor - double(ref.pixels[i][band]);
      squares += d * d;
      mean += double(ref.pixels[i][band]);
    }
  }
  const double n = 3.0 * double(ref.pixels.size());
  return 100.0 * std::sqrt(squares / n) / (mean / n);
}

class Invariance : public GlTest {
 protected:
  static screen::FrameOptions options(Scheme scheme = Scheme::ordinates) {
    screen::FrameOptions o;
    o.size = {64, 64};
    o.volume.grid_cells = 12;
    o.volume.scheme.scheme = scheme;
    return o;
  }
};

Scene scaled(Scene scene, float s) {
  for (Mesh& mesh : scene.meshes) {
    for (glm::vec3& p : mesh.positions) p *= s;
  }
  for (Light& light : scene.lights) {
    light.position *= s;
    light.range_m *= s;
    if (light.type != Light::Type::directional) light.intensity *= s * s;
  }
  for (Camera& camera : scene.cameras) {
    camera.world_from_camera[3] = glm::vec4(s * glm::vec3(camera.world_from_camera[3]), 1.0f);
    camera.znear *= s;
    camera.zfar *= s;
  }
  update_bounds(scene);
  return scene;
}

TEST_F(Invariance, Scale) {
  for (const char* name : {"cornell", "emissive", "room"}) {
    const Scene scene = load_scene(kData / (std::string(name) + ".glb"));
    const Image ref = render(context(), scene, scene.cameras.at(0), options()).image;
    for (float s : {1e-3f, 1e3f}) {
      const Scene other = scaled(scene, s);
      EXPECT_LT(rmse_percent(render(context(), other, other.cameras.at(0), options()).image, ref), 0.1)
          << name << " x " << s;
    }
  }
}

void put(std::string& out, std::uint32_t v) { out.append(reinterpret_cast<const char*>(&v), 4); }

/// The .glb with all its root nodes under a new one that is moved.
fs::path moved_copy(const fs::path& file, double metres) {
  std::ifstream in(file, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(in)), {});
  std::uint32_t length = 0;
  std::memcpy(&length, bytes.data() + 12, 4);
  nlohmann::json json = nlohmann::json::parse(bytes.substr(20, length));
  nlohmann::json& roots = json["scenes"][0]["nodes"];
  json["nodes"].push_back({{"children", roots}, {"translation", {metres, -metres, 0.5 * metres}}});
  roots = {json["nodes"].size() - 1};
  std::string text = json.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const std::string rest = bytes.substr(20 + length);
  std::string out = bytes.substr(0, 8);
  put(out, std::uint32_t(20 + text.size() + rest.size()));
  put(out, std::uint32_t(text.size()));
  out += "JSON" + text + rest;
  const fs::path copy = fs::temp_directory_path() / ("volgi_moved_" + file.filename().string());
  std::ofstream(copy, std::ios::binary) << out;
  return copy;
}

TEST_F(Invariance, Offset) {
  for (const char* name : {"cornell", "emissive"}) {
    const fs::path file = kData / (std::string(name) + ".glb");
    const Scene here = load_scene(file);
    const fs::path copy = moved_copy(file, 1e5);
    const Scene there = load_scene(copy);
    fs::remove(copy);
    EXPECT_GT(glm::length(there.world_origin - here.world_origin), 1e5);
    const Image ref = render(context(), here, here.cameras.at(0), options()).image;
    EXPECT_LT(rmse_percent(render(context(), there, there.cameras.at(0), options()).image, ref), 0.1) << name;
  }
}

TEST_F(Invariance, Range) {
  for (Scheme scheme : {Scheme::ordinates, Scheme::conservative}) {
    for (const char* name : {"cornell", "emissive"}) {
      const Scene scene = load_scene(kData / (std::string(name) + ".glb"));
      const Image ref = render(context(), scene, scene.cameras.at(0), options(scheme)).image;
      double mean = 0.0;
      for (const glm::vec3& p : ref.pixels) mean += double(p.x + p.y + p.z) / (3.0 * double(ref.pixels.size()));
      for (float factor : {1e-6f, 1e-3f, 1e4f, 1e9f}) {
        Scene other = scene;
        for (Light& light : other.lights) light.intensity *= factor;
        for (Material& material : other.materials) material.emissive_radiance *= factor;
        const Image test = render(context(), other, other.cameras.at(0), options(scheme)).image;
        double worst = 0.0;
        for (size_t i = 0; i < ref.pixels.size(); ++i) {
          for (int band = 0; band < 3; ++band) {
            ASSERT_TRUE(std::isfinite(test.pixels[i][band]));
            const double r = double(ref.pixels[i][band]);
            worst =
                std::max(worst, std::abs(double(test.pixels[i][band]) / double(factor) - r) / std::max(r, 0.01 * mean));
          }
        }
        EXPECT_LT(worst, 1e-3) << name << " x " << factor
                               << (scheme == Scheme::ordinates ? " ordinates" : " conservative");
      }
    }
  }
}

// Lights superpose: plain bounces of a linear operator. On tilted surfaces irradiance is clamped at zero where the
// staircase noise of a lit surface exceeds it, so that cornell's turned boxes keep it from being exact.
TEST_F(Invariance, SumOfLights) {
  for (auto [name, limit] : {std::pair("convex_box", 0.1), {"cornell", 0.5}}) {
    Scene scene = load_scene(kData / (std::string(name) + ".glb"));
    screen::FrameOptions o = options();
    o.volume.bounces = 4;
    const Light a = scene.lights.at(0);
    const Light b = point_light({0.3f, -0.2f, 0.4f}, {0.5f, 1.0f, 2.0f});
    const auto lit_by = [&](std::vector<Light> lights) {
      scene.lights = std::move(lights);
      return render(context(), scene, scene.cameras.at(0), o).image;
    };
    Image sum = lit_by({a});
    const Image other = lit_by({b});
    for (size_t i = 0; i < sum.pixels.size(); ++i) sum.pixels[i] += other.pixels[i];
    const double deviation = rmse_percent(lit_by({a, b}), sum);
    EXPECT_LT(deviation, limit) << name;
    RecordProperty(name, std::to_string(deviation));
  }
}

}  // namespace
}  // namespace volgi::test
