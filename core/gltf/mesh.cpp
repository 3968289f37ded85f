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

  Primitive read(int default_material) {
    Primitive out;
    out.material = in_.material < 0 ? default_material : in_.material;
    if (in_.material >= 0) check_index(document_, in_.material, document_.model.materials.size(), who_, "material");
    const Expected quantized_vec3{{3}, true, true};
    out.positions = attribute<glm::vec3>("POSITION", quantized_vec3, 0);
    const size_t count = out.positions.size();
    out.normals = attribute<glm::vec3>("NORMAL", {{3}, true, false}, count);
    out.uv[0] = attribute<glm::vec2>("TEXCOORD_0", {{2}, true, true}, count);
    out.uv[1] = attribute<glm::vec2>("TEXCOORD_1", {{2}, true, true}, count);
    out.colors = attribute<glm::vec4>("COLOR_0", {{3, 4}, true, false}, count);
    out.triangles = triangles(std::uint32_t(count));
    if (in_.attributes.contains("JOINTS_0")) warn(document_.path, "skins are ignored: meshes keep their bind pose");
    if (!in_.targets.empty()) warn(document_.path, "morph targets are ignored");
    return out;
  }

 private:
  /// Empty when the primitive has none; `count` 0 accepts any number.
  template <typename Vec>
  std::vector<Vec> attribute(const char* name, const Expected& expected, size_t count) const {
    const auto found = in_.attributes.find(name);
    if (found == in_.attributes.end()) return {};
    const std::string label = fmt::format("{} {}", who_, name);
    auto values = vectors<Vec>(read_elements(document_, found->second, expected, label));
    if (count != 0 && values.size() != count) {
      refuse(document_.path, fmt::format("{} has {} elements for {} vertices", label, values.size(), count));
    }
    return values;
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
        refuse(document_.path, fmt::format("{}: {} corners are not a multiple of three", who_, v.size()));
      }
      for (size_t i = 0; i < v.size(); i += 3) out.emplace_back(v[i], v[i + 1], v[i + 2]);
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
  for (std::uint32_t i = 0; i < primitive.triangles.size(); ++i) {
    primitive.triangles[i] = glm::uvec3(3 * i) + glm::uvec3(0, 1, 2);
  }
}

}  // namespace

std::vector<Primitive> read_mesh(const Document& document, size_t index, int default_material) {
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
    Primitive primitive = PrimitiveReader(document, in, who).read(default_material);
    if (primitive.triangles.empty()) continue;
    if (primitive.normals.empty()) unshare_corners(primitive);
    out.push_back(std::move(primitive));
  }
  return out;
}

}  // namespace volgi::gltf
