#pragma once
// What must not change a picture: the same scene in other units or elsewhere, and how far two pictures differ.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>

#include "core/image.h"
#include "core/scene.h"

namespace volgi::test {

/// 100 times the root mean square of test / factor - ref, of the mean of ref; over all pixels and bands.
inline double rmse_percent(const Image& test, const Image& ref, double factor = 1.0) {
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

/// Largest deviation of test / factor from ref, of the greater of ref and a hundredth of its mean.
inline double worst_deviation(const Image& test, const Image& ref, double factor) {
  double mean = 0.0;
  for (const glm::vec3& p : ref.pixels) mean += double(p.x + p.y + p.z) / (3.0 * double(ref.pixels.size()));
  double worst = 0.0;
  for (size_t i = 0; i < ref.pixels.size(); ++i) {
    for (int band = 0; band < 3; ++band) {
      const double t = double(test.pixels[i][band]), r = double(ref.pixels[i][band]);
      if (!std::isfinite(t)) return INFINITY;
      worst = std::max(worst, std::abs(t / factor - r) / std::max(r, 0.01 * mean));
    }
  }
  return worst;
}

inline Image sum_of(Image a, const Image& b) {
  for (size_t i = 0; i < a.pixels.size(); ++i) a.pixels[i] += b.pixels[i];
  return a;
}

/// Mean of all bands; fails where light is not finite or negative.
inline double mean_light(const Image& image) {
  double sum = 0.0;
  for (const glm::vec3& p : image.pixels) {
    EXPECT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
    EXPECT_TRUE(glm::all(glm::greaterThanEqual(p, glm::vec3(0.0f))));
    sum += double(p.x + p.y + p.z) / 3.0;
  }
  return sum / double(image.pixels.size());
}

/// Lengths times s, and what makes the picture the same.
inline Scene scaled(Scene scene, float s) {
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

/// All lights and emitters times `factor`.
inline Scene brighter(Scene scene, float factor) {
  for (Light& light : scene.lights) light.intensity *= factor;
  for (Material& material : scene.materials) material.emissive_radiance *= factor;
  return scene;
}

/// The .glb with all its root nodes under a new one that is moved.
inline Scene load_moved(const std::filesystem::path& file, double metres) {
  const auto put = [](std::string& out, std::uint32_t v) { out.append(reinterpret_cast<const char*>(&v), 4); };
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
  // Tests run beside each other in processes of their own.
  const std::filesystem::path copy = std::filesystem::temp_directory_path() /
                                     ("volgi_" + std::to_string(::getpid()) + "_moved_" + file.filename().string());
  std::ofstream(copy, std::ios::binary) << out;
  Scene scene = load_scene(copy);
  std::filesystem::remove(copy);
  return scene;
}

}  // namespace volgi::test
