#include "core/surface.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/image.h"
#include "core/texel_filter_internal.h"
#include "shaders/shared/material.shared.h"

namespace volgi {
namespace {

template <typename T>
T interpolate(const std::vector<T>& values, glm::uvec3 corners, glm::vec3 weights) {
  return weights.x * values[corners.x] + weights.y * values[corners.y] + weights.z * values[corners.z];
}

struct Corners {
  glm::uvec3 indices;
  glm::vec3 weights;
};

glm::vec4 sample_use(const Scene& scene, const Mesh& mesh, const TextureUse& use, const Corners& at, bool srgb) {
  if (use.texture < 0) return glm::vec4(1.0f);
  const auto& texcoords = mesh.uv[size_t(use.texcoord)];
  const glm::vec2 texcoord = texcoords.empty() ? glm::vec2(0.0f) : interpolate(texcoords, at.indices, at.weights);
  return sample_texture(scene, use.texture, glm::vec2(use.uv_from_texcoord * glm::vec3(texcoord, 1.0f)), srgb);
}

/// The shading normal after the material's normal map: tangents along its texture coordinates, as those of a file
/// without TANGENT (glTF 2.0, 3.7.2.1). The map counts where it does not turn the surface away from its own front.
glm::vec3 mapped_normal(const Scene& scene, const Mesh& mesh, const Corners& at, const SurfacePoint& point) {
  const Material& material = scene.materials[size_t(mesh.material)];
  const auto& uv = mesh.uv[size_t(material.normal.texcoord)];
  const glm::vec3 n = point.shading_normal;
  if (uv.empty()) return n;
  const glm::vec3 a = mesh.positions[at.indices.x];
  const glm::vec3 e1 = mesh.positions[at.indices.y] - a, e2 = mesh.positions[at.indices.z] - a;
  const glm::vec2 d1 = uv[at.indices.y] - uv[at.indices.x], d2 = uv[at.indices.z] - uv[at.indices.x];
  const float turned = d1.x * d2.y - d2.x * d1.y;
  glm::vec3 tangent = (e1 * d2.y - e2 * d1.y) * (turned < 0.0f ? -1.0f : 1.0f);
  tangent -= n * glm::dot(n, tangent);
  if (turned == 0.0f || !(glm::length(tangent) > 0.0f)) return n;
  tangent = glm::normalize(tangent);
  // v grows downwards in the picture, green upwards.
  const glm::vec3 bitangent = glm::cross(n, tangent) * (turned < 0.0f ? 1.0f : -1.0f);
  const glm::vec3 texel = glm::vec3(sample_use(scene, mesh, material.normal, at, false)) * 2.0f - 1.0f;
  const glm::vec3 mapped = material.normal_scale * (texel.x * tangent + texel.y * bitangent) + texel.z * n;
  const bool usable = glm::length(mapped) > 0.0f && glm::dot(mapped, point.geometric_normal) > 0.0f;
  return usable ? glm::normalize(mapped) : n;
}

float alpha_of(const Material& material, float alpha) {
  if (material.alpha_mode == AlphaMode::opaque) return 1.0f;
  if (material.alpha_mode == AlphaMode::mask) return alpha + ALPHA_CUTOFF_SLACK >= material.alpha_cutoff ? 1.0f : 0.0f;
  return std::clamp(alpha, 0.0f, 1.0f);
}

/// Largest (or, for the metal, smallest) value of a texture, per channel.
glm::vec4 texture_extreme(const Scene& scene, const TextureUse& use, bool srgb, bool largest) {
  if (use.texture < 0) return glm::vec4(1.0f);
  const TextureImage& image = scene.images[size_t(scene.textures[size_t(use.texture)].image)];
  std::array<std::uint8_t, 4> extreme{};
  extreme.fill(largest ? 0 : 255);
  for (size_t i = 0; i < image.rgba.size(); ++i) {
    std::uint8_t& e = extreme[i % 4];
    e = largest ? std::max(e, image.rgba[i]) : std::min(e, image.rgba[i]);
  }
  return decoded_texel(extreme.data(), srgb);
}

}  // namespace

shared::Reflectance reflectance_of(const Material& material, glm::vec3 base, float metallic) {
  if (material.unlit) return {};
  return shared::reflectance_of(base, metallic, material.dielectric_0(), material.specular_factor,
                                material.lambertian ? 1 : 0);
}

glm::vec4 sample_texture(const Scene& scene, int texture, glm::vec2 uv, bool srgb) {
  const Texture& t = scene.textures[size_t(texture)];
  const TextureImage& image = scene.images[size_t(t.image)];
  const std::uint8_t* const texels = image.rgba.data();
  const auto width = size_t(image.width);
  return filter_texels(t.sampler, {image.width, image.height}, wrapped(uv, t.sampler), t.sampler.magnify_nearest,
                       [&](int x, int y) { return decoded_texel(texels + 4 * (size_t(y) * width + size_t(x)), srgb); });
}

SurfacePoint surface_point(const Scene& scene, const Mesh& mesh, std::uint32_t triangle, float u, float v) {
  const Corners at{mesh.triangles[triangle], glm::vec3(1.0f - u - v, u, v)};
  const Material& material = scene.materials[size_t(mesh.material)];
  SurfacePoint point{};
  point.position = interpolate(mesh.positions, at.indices, at.weights);

  const glm::dvec3 a(mesh.positions[at.indices.x]);
  const glm::dvec3 cross =
      glm::cross(glm::dvec3(mesh.positions[at.indices.y]) - a, glm::dvec3(mesh.positions[at.indices.z]) - a);
  const double twice_area = glm::length(cross);
  if (twice_area > 0.0) point.geometric_normal = glm::vec3(cross / twice_area);
  const glm::vec3 normal = interpolate(mesh.normals, at.indices, at.weights);
  const float normal_length = glm::length(normal);
  point.shading_normal = normal_length > 0.0f ? normal / normal_length : point.geometric_normal;
  if (glm::dot(point.shading_normal, point.geometric_normal) < 0.0f) point.shading_normal = -point.shading_normal;

  glm::vec4 base = material.base_color_factor * sample_use(scene, mesh, material.base_color, at, true);
  const bool glass = material.alpha_mode == AlphaMode::glass;
  if (!mesh.colors.empty()) {
    const glm::vec4 color = interpolate(mesh.colors, at.indices, at.weights);
    base *= glass ? glm::vec4(glm::vec3(color), 1.0f) : color;
  }
  point.tint = glm::vec3(1.0f);
  if (glass) {
    const shared::Pane pane = shared::pane_of(base, 1);
    base = glm::vec4(glm::vec3(base) * pane.reflects, pane.stops);
    point.tint = pane.tint;
  }
  if (material.normal.texture >= 0) point.shading_normal = mapped_normal(scene, mesh, at, point);
  point.alpha = alpha_of(material, base.w);
  if (material.unlit) {
    point.unlit = glm::vec3(base);
    return point;
  }
  const glm::vec4 texel = sample_use(scene, mesh, material.metallic, at, false);
  const shared::Reflectance reflectance = reflectance_of(material, glm::vec3(base), material.metallic_factor * texel.z);
  point.diffuse = reflectance.diffuse;
  point.reflectance_0 = reflectance.at_0;
  point.reflectance_90 = reflectance.at_90;
  point.roughness = std::clamp(material.roughness_factor * texel.y, 0.0f, 1.0f);
  point.phong = material.phong;
  point.albedo = shared::surface_albedo(reflectance, point.roughness);
  if (material.is_emissive()) {
    point.emission = material.emissive_radiance * glm::vec3(sample_use(scene, mesh, material.emissive, at, true));
  }
  return point;
}

bool shines(const Scene& scene) {
  return std::any_of(scene.materials.begin(), scene.materials.end(), [](const Material& m) {
    return !m.lambertian && !m.unlit && (m.specular_factor > 0.0f || m.metallic_factor > 0.0f);
  });
}

bool has_phong_lobes(const Scene& scene) {
  return std::any_of(scene.materials.begin(), scene.materials.end(), [](const Material& m) { return m.phong; });
}

float largest_albedo(const Scene& scene) {
  std::vector<glm::vec3> of_material;
  of_material.reserve(scene.materials.size());
  for (const Material& m : scene.materials) {
    // Linear in the metallic part, and falling with the roughness.
    const glm::vec4 least = texture_extreme(scene, m.metallic, false, false);
    const glm::vec4 most = texture_extreme(scene, m.metallic, false, true);
    const glm::vec3 base = glm::vec3(m.base_color_factor) * glm::vec3(texture_extreme(scene, m.base_color, true, true));
    const float roughness = m.roughness_factor * least.y;
    of_material.push_back(
        glm::max(shared::surface_albedo(reflectance_of(m, base, m.metallic_factor * least.z), roughness),
                 shared::surface_albedo(reflectance_of(m, base, m.metallic_factor * most.z), roughness)));
  }
  float largest = 0.0f;
  for (const Mesh& mesh : scene.meshes) {
    glm::vec3 color(mesh.colors.empty() ? 1.0f : 0.0f);
    for (const glm::vec4& c : mesh.colors) color = glm::max(color, glm::vec3(c));
    const glm::vec3 albedo = of_material[size_t(mesh.material)] * color;
    largest = std::max({largest, albedo.x, albedo.y, albedo.z});
  }
  return std::clamp(largest, 0.0f, 1.0f);
}

}  // namespace volgi
