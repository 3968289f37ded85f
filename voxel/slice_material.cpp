#include <algorithm>
#include <cmath>

#include "core/surface.h"
#include "shaders/shared/material.shared.h"
#include "voxel/slice_internal.h"

namespace volgi::slicing {

namespace {

/// Barycentric weights of a fine column. Inlined: a vec3 that is returned goes through memory piecemeal.
inline __attribute__((always_inline)) glm::vec3 weights_at(const SliceTriangle& t, const Long3& n, int axis, int fine_b,
                                                           int fine_c) {
  const int b = shared::axis_b(axis), c = shared::axis_c(axis);
  const std::int64_t at_b = node_position(fine_b), at_c = node_position(fine_c);
  const double per_area = 1.0 / double(n[size_t(axis)]);
  glm::vec3 weights;
  for (int k = 0; k < 3; ++k) {
    const glm::i64vec3 p(t.vertex[size_t(k + 1) % 3]), q(t.vertex[size_t(k + 2) % 3]);
    const std::int64_t area = (q[b] - p[b]) * (at_c - p[c]) - (q[c] - p[c]) * (at_b - p[b]);
    weights[k] = float(double(area) * per_area);
  }
  return weights;
}

/// Textures at the level in which a square of `footprint` cells has one texel in the mean: one level for the whole
/// triangle, so that passes along different axes agree.
float level_of_detail(const Scene& scene, const Mesh& mesh, const glm::uvec3& corners, const TextureUse& use,
                      double twice_area_cells, float footprint) {
  if (use.texture < 0) return 0.0f;
  const auto& uv = mesh.uv[size_t(use.texcoord)];
  if (uv.empty()) return 0.0f;
  const glm::vec2 u = uv[corners.y] - uv[corners.x], v = uv[corners.z] - uv[corners.x];
  const TextureImage& image = scene.images[size_t(scene.textures[size_t(use.texture)].image)];
  const double turned = double(glm::determinant(glm::mat2(use.uv_from_texcoord)));
  const double texels = std::abs(double(u.x * v.y - u.y * v.x) * turned) * image.width * image.height;
  const double of_footprint = texels * double(footprint * footprint) / std::max(twice_area_cells, 1e-20);
  return 0.5f * std::log2(float(std::clamp(of_footprint, 1.0, 1e30)));
}

/// @param base  baseColor times COLOR_0; @param texel, emissive_texel  of the textures or 1.
SlicedMaterial sliced(const Material& m, glm::vec4 base, const glm::vec4& texel, const glm::vec3& emissive_texel) {
  if (m.alpha_mode == AlphaMode::glass) {
    const shared::Pane pane = shared::pane_of(base, 0);
    base = glm::vec4(glm::vec3(base) * pane.reflects, pane.stops);
  }
  const shared::Reflectance reflectance = reflectance_of(m, glm::vec3(base), m.metallic_factor * texel.z);
  SlicedMaterial out{shared::surface_albedo(reflectance, m.roughness_factor * texel.y), glm::vec3(0.0f), 1.0f};
  if (m.is_emissive()) out.emission = m.emissive_radiance * emissive_texel;
  if (m.alpha_mode == AlphaMode::mask) out.stopped = base.a + ALPHA_CUTOFF_SLACK >= m.alpha_cutoff ? 1.0f : 0.0f;
  if (m.passes_by_chance()) out.stopped = glm::clamp(base.a, 0.0f, 1.0f);
  return out;
}

}  // namespace

std::vector<std::optional<SlicedMaterial>> constant_materials(const Scene& scene) {
  std::vector<std::optional<SlicedMaterial>> out(scene.meshes.size());
  for (size_t i = 0; i < out.size(); ++i) {
    const Mesh& mesh = scene.meshes[i];
    const Material& m = scene.materials[size_t(mesh.material)];
    const bool textured =
        m.base_color.texture >= 0 || m.metallic.texture >= 0 || (m.is_emissive() && m.emissive.texture >= 0);
    if (!textured && mesh.colors.empty()) out[i] = sliced(m, m.base_color_factor, glm::vec4(1.0f), glm::vec3(1.0f));
  }
  return out;
}

TriangleMaterial::TriangleMaterial(const SlicedScene& s, const SliceTriangle& t, const Long3& n, int axis,
                                   float footprint)
    : s_(s), t_(t), n_(n), axis_(axis) {
  const auto& constant = s.constant[t.mesh];
  if (constant) {
    constant_ = &*constant;
    return;
  }
  corners_ = s.mesh(t).triangles[t.triangle];
  const double steps = double(SLICE_STEPS) * double(SLICE_STEPS);
  const double twice_area = glm::length(glm::dvec3(double(n[0]), double(n[1]), double(n[2]))) / steps;
  const auto lod = [&](const TextureUse& use) {
    return level_of_detail(*s.scene, s.mesh(t), corners_, use, twice_area, footprint);
  };
  const Material& m = s.material(t);
  base_lod_ = lod(m.base_color);
  metallic_lod_ = lod(m.metallic);
  if (m.is_emissive()) emissive_lod_ = lod(m.emissive);
}

SlicedMaterial TriangleMaterial::at(int fine_b, int fine_c) const {
  return constant_ != nullptr ? *constant_ : at(weights_at(t_, n_, axis_, fine_b, fine_c));
}

SlicedMaterial TriangleMaterial::at_cell(int cell_b, int cell_c) const {
  if (constant_ != nullptr) return *constant_;
  const glm::vec3 inside = glm::clamp(weights_at(t_, n_, axis_, kFine * cell_b + 1, kFine * cell_c + 1), 0.0f, 1.0f);
  return at(inside / (inside.x + inside.y + inside.z));
}

SlicedMaterial TriangleMaterial::at(const glm::vec3& weights) const {
  const Mesh& mesh = s_.mesh(t_);
  const Material& m = s_.material(t_);
  glm::vec4 base = m.base_color_factor * texel(m.base_color, weights, base_lod_, true);
  if (!mesh.colors.empty()) {
    glm::vec4 color =
        weights.x * mesh.colors[corners_.x] + weights.y * mesh.colors[corners_.y] + weights.z * mesh.colors[corners_.z];
    if (m.alpha_mode == AlphaMode::glass) color.a = 1.0f;
    base *= color;
  }
  const glm::vec4 metallic = texel(m.metallic, weights, metallic_lod_, false);
  const glm::vec3 emissive(m.is_emissive() ? texel(m.emissive, weights, emissive_lod_, true) : glm::vec4(1.0f));
  return sliced(m, base, metallic, emissive);
}

glm::vec4 TriangleMaterial::texel(const TextureUse& use, const glm::vec3& weights, float lod, bool srgb) const {
  if (use.texture < 0) return glm::vec4(1.0f);
  const auto& uv = s_.mesh(t_).uv[size_t(use.texcoord)];
  if (uv.empty()) return s_.mipmaps->sample(use.texture, glm::vec2(use.uv_from_texcoord[2]), 0.0f, srgb);
  const glm::vec2 at = weights.x * uv[corners_.x] + weights.y * uv[corners_.y] + weights.z * uv[corners_.z];
  return s_.mipmaps->sample(use.texture, glm::vec2(use.uv_from_texcoord * glm::vec3(at, 1.0f)), lod, srgb);
}

}  // namespace volgi::slicing
