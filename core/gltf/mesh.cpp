#include <fmt/format.h>

#include <algorithm>

#include "core/gltf/gltf_internal.h"

namespace volgi::gltf {
namespace {

template <typename Vec>
std::vector<Vec> vectors(const Elements& elements) {
  std::vector<Vec> out(elements.count(), Vec(1.0f));  // alpha 1 where only three components are given
  const size_t components = std::min(elements.components, size_t(Vec::length()));
  for (size_t i = 0; i < out.size(); ++i) {
    for (size_t c = 0; c < components; ++c) out[i][int(c)] = elements.values[i * elements.components + c];
  }
  return out;
}

class PrimitiveReader {
 public:
  PrimitiveReader(const Document& document, const tinygltf::Primitive& in, std::string who)
      : document_(document), in_(in), who_(std::move(who)) {}

  Primitive read(const Materials& materials) {
    Primitive out;
    out.material = in_.material < 0 ? int(materials.materials.size()) - 1 : in_.material;
    if (in_.material >= 0) check_index(document_, in_.material, document_.model.materials.size(), who_, "material");
    const Expected quantized_vec3{{3}, true, true};
    out.positions = attribute<glm::vec3>("POSITION", quantized_vec3, 0);
    const size_t count = out.positions.size();
    out.normals = attribute<glm::vec3>("NORMAL", {{3}, true, false, true}, count);
    const std::array<int, 2> sets = materials.uv_sets[size_t(out.material)];
    for (size_t k = 0; k < 2; ++k) {
      if (k == 1 && sets[1] == sets[0]) break;
      out.uv[k] = attribute<glm::vec2>(fmt::format("TEXCOORD_{}", sets[k]), {{2}, true, true, true}, count);
    }
    out.colors = attribute<glm::vec4>("COLOR_0", {{3, 4}, true, false}, count);
    out.triangles = triangles(std::uint32_t(count));
    read_targets(count, out);
    read_influences(count, out);
    return out;
  }

 private:
  /// Empty when the primitive has none; `count` 0 accepts any number.
  template <typename Vec>
  std::vector<Vec> attribute(const std::string& name, const Expected& expected, size_t count) const {
    return attribute_of<Vec>(in_.attributes, name, expected, count);
  }
  template <typename Vec>
  std::vector<Vec> attribute_of(const std::map<std::string, int>& attributes, const std::string& name,
                                const Expected& expected, size_t count) const {
    const auto found = attributes.find(name);
    if (found == attributes.end()) return {};
    const std::string label = fmt::format("{} {}", who_, name);
    auto values = vectors<Vec>(read_elements(document_, found->second, expected, label));
    if (count != 0 && values.size() != count) {
      refuse(document_.path, fmt::format("{} has {} elements for {} vertices", label, values.size(), count));
    }
    return values;
  }

  void read_targets(size_t count, Primitive& out) const {
    constexpr size_t most = 1024;
    if (in_.targets.size() > most)
      refuse(document_.path, fmt::format("{} has {} morph targets", who_, in_.targets.size()));
    for (const std::map<std::string, int>& target : in_.targets) {
      Primitive::Target& made = out.targets.emplace_back();
      made.positions = attribute_of<glm::vec3>(target, "POSITION", {{3}, true, true}, count);
      made.normals = attribute_of<glm::vec3>(target, "NORMAL", {{3}, true, true, true}, count);
    }
  }

  /// All sets of four, as far as there are any.
  void read_influences(size_t count, Primitive& out) const {
    constexpr int most = 8;
    for (int set = 0; set < most; ++set) {
      const auto joints = attribute<glm::vec4>(fmt::format("JOINTS_{}", set), {{4}, false, true}, count);
      const auto weights = attribute<glm::vec4>(fmt::format("WEIGHTS_{}", set), {{4}, true, false, true}, count);
      if (joints.empty() || weights.empty()) break;
      Primitive::Influences& made = out.influences.emplace_back();
      for (const glm::vec4& j : joints) made.joints.emplace_back(glm::max(j, glm::vec4(0.0f)));
      for (const glm::vec4& w : weights) made.weights.push_back(glm::max(w, glm::vec4(0.0f)));
    }
    normalize_weights(count, out);
  }

  static void normalize_weights(size_t count, Primitive& out) {
    for (size_t i = 0; i < count && !out.influences.empty(); ++i) {
      float sum = 0.0f;
      for (const auto& set : out.influences)
        sum += set.weights[i].x + set.weights[i].y + set.weights[i].z + set.weights[i].w;
      if (!(sum > 0.0f))
        out.influences[0].weights[i] = glm::vec4(1.0f, 0.0f, 0.0f, 0.0f);
      else
        for (auto& set : out.influences) set.weights[i] /= sum;
    }
  }

  std::vector<std::uint32_t> corner_list(std::uint32_t vertex_count) const {
    std::vector<std::uint32_t> corners;
    if (in_.indices >= 0) {
      corners = read_indices(document_, in_.indices, who_ + " indices");
    } else {
      corners.resize(vertex_count);
      for (std::uint32_t i = 0; i < vertex_count; ++i) corners[i] = i;
    }
    const auto wrong = std::find_if(corners.begin(), corners.end(), [&](auto i) { return i >= vertex_count; });
    if (wrong != corners.end()) {
      refuse(document_.path, fmt::format("{}: index {} (at position {}) of {} vertices", who_, *wrong,
                                         wrong - corners.begin(), vertex_count));
    }
    return corners;
  }

  std::vector<glm::uvec3> triangles(std::uint32_t vertex_count) const {
    const std::vector<std::uint32_t> v = corner_list(vertex_count);
    std::vector<glm::uvec3> out;
    if (in_.mode == TINYGLTF_MODE_TRIANGLES) {
      if (v.size() % 3 != 0) {
        repair(document_,
               fmt::format("{}: {} corners are not a multiple of three; the last ones are left out", who_, v.size()));
      }
      for (size_t i = 0; i + 2 < v.size(); i += 3) out.emplace_back(v[i], v[i + 1], v[i + 2]);
      return out;
    }
    const bool strip = in_.mode == TINYGLTF_MODE_TRIANGLE_STRIP;
    for (size_t i = 0; i + 2 < v.size(); ++i) {  // glTF 2.0, 3.7.2.1
      if (strip) {
        out.emplace_back(v[i], v[i + 1 + i % 2], v[i + 2 - i % 2]);
      } else {
        out.emplace_back(v[i + 1], v[i + 2], v[0]);
      }
    }
    return out;
  }

  const Document& document_;
  const tinygltf::Primitive& in_;
  std::string who_;
};

/// A flat normal belongs to one triangle, so its corners cannot be shared.
void unshare_corners(Primitive& primitive) {
  const auto unshared = [&](auto& values) {
    if (values.empty()) return;
    std::remove_reference_t<decltype(values)> corners;
    corners.reserve(3 * primitive.triangles.size());
    for (const glm::uvec3& t : primitive.triangles) {
      for (int c = 0; c < 3; ++c) corners.push_back(values[t[c]]);
    }
    values = std::move(corners);
  };
  unshared(primitive.positions);
  unshared(primitive.uv[0]);
  unshared(primitive.uv[1]);
  unshared(primitive.colors);
  for (Primitive::Target& target : primitive.targets) {
    unshared(target.positions);
    unshared(target.normals);
  }
  for (Primitive::Influences& set : primitive.influences) {
    unshared(set.joints);
    unshared(set.weights);
  }
  for (std::uint32_t i = 0; i < primitive.triangles.size(); ++i) {
    primitive.triangles[i] = glm::uvec3(3 * i) + glm::uvec3(0, 1, 2);
  }
}

}  // namespace

Primitive morphed(const Primitive& primitive, const std::vector<double>& weights) {
  Primitive out = primitive;
  for (size_t k = 0; k < std::min(weights.size(), primitive.targets.size()); ++k) {
    const auto weight = float(weights[k]);
    if (weight == 0.0f) continue;
    const Primitive::Target& target = primitive.targets[k];
    for (size_t i = 0; i < target.positions.size(); ++i) out.positions[i] += weight * target.positions[i];
    for (size_t i = 0; i < std::min(target.normals.size(), out.normals.size()); ++i)
      out.normals[i] += weight * target.normals[i];
  }
  return out;
}

std::vector<Primitive> read_mesh(const Document& document, size_t index, const Materials& materials) {
  const tinygltf::Mesh& mesh = document.model.meshes[index];
  std::vector<Primitive> out;
  for (size_t i = 0; i < mesh.primitives.size(); ++i) {
    const tinygltf::Primitive& in = mesh.primitives[i];
    const std::string who = fmt::format("{} primitive {}", element("mesh", index, mesh.name), i);
    if (in.mode < TINYGLTF_MODE_POINTS || in.mode > TINYGLTF_MODE_TRIANGLE_FAN) {
      refuse(document.path, fmt::format("{} has the unknown mode {}", who, in.mode));
    }
    if (in.mode < TINYGLTF_MODE_TRIANGLES) {
      warn(document.path, "points and lines are ignored");
      continue;
    }
    if (!in.attributes.contains("POSITION")) {
      warn(document.path, fmt::format("{} has no POSITION and is ignored", who));
      continue;
    }
    Primitive primitive = PrimitiveReader(document, in, who).read(materials);
    if (primitive.triangles.empty()) continue;
    if (primitive.normals.empty()) unshare_corners(primitive);
    out.push_back(std::move(primitive));
  }
  return out;
}

}  // namespace volgi::gltf
