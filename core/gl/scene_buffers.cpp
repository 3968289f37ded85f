#include "core/gl/scene_buffers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/gtc/type_precision.hpp>

#include "core/error.h"
#include "core/mipmaps.h"
#include "shaders/shared/material.shared.h"
#include "shared/scene_vertex.shared.h"

namespace volgi::gl {
namespace {

struct Vertex {
  glm::vec3 position;
  glm::vec3 normal;
  std::array<glm::vec2, 2> uv;
  glm::vec4 color;
  glm::vec3 geometric_normal;
  GLuint object_id;
};
static_assert(sizeof(Vertex) == 72 && offsetof(Vertex, geometric_normal) == 56);
static_assert(sizeof(Vertex) == VERTEX_FLOATS * sizeof(float));
static_assert(offsetof(Vertex, position) == VERTEX_POSITION * sizeof(float));
static_assert(offsetof(Vertex, uv) == VERTEX_UV0 * sizeof(float) && VERTEX_UV1 == VERTEX_UV0 + 2);
static_assert(offsetof(Vertex, color) == VERTEX_COLOR * sizeof(float));

/// Unit front-side normal; zero without area, which no rasterizer draws. Double, so that slivers keep a direction.
glm::vec3 front_normal(const std::array<glm::vec3, 3>& p) {
  const glm::dvec3 n = glm::cross(glm::dvec3(p[1]) - glm::dvec3(p[0]), glm::dvec3(p[2]) - glm::dvec3(p[0]));
  const double length = glm::length(n);
  return length > 0.0 ? glm::vec3(n / length) : glm::vec3(0.0f);
}

void append_mesh(const Mesh& mesh, std::vector<Vertex>& vertices) {
  for (const glm::uvec3& triangle : mesh.triangles) {
    const glm::vec3 normal =
        front_normal({mesh.positions[triangle.x], mesh.positions[triangle.y], mesh.positions[triangle.z]});
    for (int corner = 0; corner < 3; ++corner) {
      const size_t i = triangle[corner];
      Vertex v{mesh.positions[i], mesh.normals[i], {}, glm::vec4(1.0f), normal, mesh.object_id};
      for (size_t set = 0; set < 2; ++set) {
        if (!mesh.uv[set].empty()) v.uv[set] = mesh.uv[set][i];
      }
      if (!mesh.colors.empty()) v.color = mesh.colors[i];
      vertices.push_back(v);
    }
  }
}

VertexArray make_vertex_array(GLuint buffer) {
  GLuint id = 0;
  glCreateVertexArrays(1, &id);
  count_object();
  glVertexArrayVertexBuffer(id, 0, buffer, 0, sizeof(Vertex));
  const auto attribute = [id](GLuint index, GLint size, size_t offset) {
    glEnableVertexArrayAttrib(id, index);
    glVertexArrayAttribFormat(id, index, size, GL_FLOAT, GL_FALSE, GLuint(offset));
    glVertexArrayAttribBinding(id, index, 0);
  };
  attribute(0, 3, offsetof(Vertex, position));
  attribute(1, 3, offsetof(Vertex, normal));
  attribute(2, 2, offsetof(Vertex, uv));
  attribute(3, 2, offsetof(Vertex, uv) + sizeof(glm::vec2));
  attribute(4, 4, offsetof(Vertex, color));
  attribute(5, 3, offsetof(Vertex, geometric_normal));
  glEnableVertexArrayAttrib(id, 6);
  glVertexArrayAttribIFormat(id, 6, 1, GL_UNSIGNED_INT, GLuint(offsetof(Vertex, object_id)));
  glVertexArrayAttribBinding(id, 6, 0);
  return VertexArray(id);
}

GLenum gl_wrap(Wrap wrap) {
  switch (wrap) {
    case Wrap::mirrored_repeat:
      return GL_MIRRORED_REPEAT;
    case Wrap::clamp_to_edge:
      return GL_CLAMP_TO_EDGE;
    case Wrap::repeat:
      break;
  }
  return GL_REPEAT;
}

GLenum gl_min_filter(const Sampler& s) {
  if (!s.mipmap) return s.minify_nearest ? GL_NEAREST : GL_LINEAR;
  if (s.minify_nearest) return s.mipmap_nearest ? GL_NEAREST_MIPMAP_NEAREST : GL_NEAREST_MIPMAP_LINEAR;
  return s.mipmap_nearest ? GL_LINEAR_MIPMAP_NEAREST : GL_LINEAR_MIPMAP_LINEAR;
}

/// Linear light in 16 bits, levels of our own (core/mipmaps.h).
Texture upload_texture(const TextureImage& image, const Sampler& sampler, bool srgb) {
  const int levels = sampler.mipmap ? mip_count(image) : 1;
  Texture t = Texture::make_2d(GL_RGBA16, image.width, image.height, levels);
  // Rows are handed over in bands: a large texture is never there as floats.
  constexpr size_t band_texels = size_t(1) << 16;
  std::vector<std::vector<glm::u16vec4>> bands(static_cast<size_t>(levels));
  visit_mip_rows(image, srgb, [&](int level, int y, std::span<const glm::vec4> row) {
    if (level >= levels) return;
    std::vector<glm::u16vec4>& band = bands[size_t(level)];
    for (const glm::vec4& v : row) band.emplace_back(v * 65535.0f + 0.5f);
    const int height = std::max(image.height >> level, 1);
    if (band.size() < band_texels && y + 1 < height) return;
    const auto rows = GLsizei(band.size() / row.size());
    glTextureSubImage2D(t.id(), GLint(level), 0, y + 1 - rows, GLsizei(row.size()), rows, GL_RGBA, GL_UNSIGNED_SHORT,
                        band.data());
    band.clear();
  });
  t.filter(gl_min_filter(sampler), sampler.magnify_nearest ? GL_NEAREST : GL_LINEAR);
  t.wrap(gl_wrap(sampler.wrap_s), gl_wrap(sampler.wrap_t));
  return t;
}

size_t texture_bytes(const Texture& t, bool mipmapped) {
  const size_t base = size_t(t.size().x) * size_t(t.size().y) * 8;
  return mipmapped ? base * 4 / 3 : base;
}

}  // namespace

SceneBuffers::SceneBuffers(const Scene& scene) : materials_(scene.materials) {
  set_geometry(scene);
  const auto add_texture = [&](const TextureUse& use, bool srgb) {
    if (use.texture < 0 || texture_of_.contains({use.texture, srgb})) return;
    const volgi::Texture& texture = scene.textures[size_t(use.texture)];
    texture_of_[{use.texture, srgb}] = textures_.size();
    textures_.push_back(upload_texture(scene.images[size_t(texture.image)], texture.sampler, srgb));
    texture_bytes_ += texture_bytes(textures_.back(), texture.sampler.mipmap);
  };
  for (const Material& m : materials_) {
    add_texture(m.base_color, true);
    add_texture(m.metallic, false);
    add_texture(m.emissive, true);
    add_texture(m.normal, false);
  }
}

void SceneBuffers::set_geometry(const Scene& scene) {
  triangles_ = scene.triangle_count();
  ranges_.clear();
  std::vector<const Mesh*> meshes;
  for (const Mesh& mesh : scene.meshes) {
    if (!mesh.triangles.empty()) meshes.push_back(&mesh);
  }
  std::stable_sort(meshes.begin(), meshes.end(),
                   [](const Mesh* a, const Mesh* b) { return a->material < b->material; });
  std::vector<Vertex> vertices;
  vertices.reserve(3 * triangles_);
  for (const Mesh* mesh : meshes) {
    const auto first = GLint(vertices.size());
    append_mesh(*mesh, vertices);
    if (ranges_.empty() || ranges_.back().material != mesh->material) ranges_.push_back({mesh->material, first, 0});
    ranges_.back().count += GLsizei(vertices.size()) - first;
  }
  const size_t bytes = vertices.size() * sizeof(Vertex);
  if (vertices_.id() != 0 && bytes <= vertices_.bytes()) {
    vertices_.upload(vertices.data(), bytes);
    return;
  }
  if (vertices_.id() == 0) {
    vertices_ = Buffer(vertices);
  } else {
    vertices_ = Buffer(bytes + bytes / 5);
    vertices_.upload(vertices.data(), bytes);
  }
  vertex_array_ = make_vertex_array(vertices_.id());
}

void SceneBuffers::bind_use(const Program& program, GLuint unit, const TextureUse& use, bool srgb,
                            const char* texcoord_name, const char* transform_name) const {
  program.set(texcoord_name, use.texture < 0 ? -1 : use.texcoord);
  if (use.texture < 0) return;
  program.set(transform_name, use.uv_from_texcoord);
  textures_[texture_of_.at({use.texture, srgb})].bind(unit);
}

void SceneBuffers::bind_material(const Program& program, int material) const {
  const Material& m = materials_[size_t(material)];
  program.set("material_base_color_factor", m.base_color_factor);
  program.set("material_metallic_factor", m.metallic_factor);
  program.set("material_roughness_factor", m.roughness_factor);
  program.set("material_dielectric_0", m.dielectric_0());
  program.set("material_dielectric_90", m.specular_factor);
  program.set("material_lambertian", m.lambertian ? 1 : 0);
  program.set("material_emissive_radiance", m.emissive_radiance);
  program.set("material_alpha_mode", static_cast<int>(m.alpha_mode));
  program.set("material_alpha_cutoff", m.alpha_cutoff);
  program.set("material_double_sided", m.double_sided ? 1 : 0);
  program.set("material_unlit", m.unlit ? 1 : 0);
  program.set("material_sample", sample_);
  program.set("material_normal_scale", m.normal_scale);
  bind_use(program, MATERIAL_BASE_COLOR_UNIT, m.base_color, true, "material_base_color_texcoord",
           "material_base_color_transform");
  bind_use(program, MATERIAL_METALLIC_UNIT, m.metallic, false, "material_metallic_texcoord",
           "material_metallic_transform");
  bind_use(program, MATERIAL_EMISSIVE_UNIT, m.emissive, true, "material_emissive_texcoord",
           "material_emissive_transform");
  bind_use(program, MATERIAL_NORMAL_UNIT, m.normal, false, "material_normal_texcoord", "material_normal_transform");
}

void SceneBuffers::draw(const Program& program) const {
  program.use();
  glBindVertexArray(vertex_array_.id());
  for (const Range& range : ranges_) {
    bind_material(program, range.material);
    glDrawArrays(GL_TRIANGLES, range.first, range.count);
  }
  glBindVertexArray(0);
}

bool SceneBuffers::has_glass() const {
  return std::any_of(ranges_.begin(), ranges_.end(), [&](const Range& range) {
    return materials_[size_t(range.material)].alpha_mode == AlphaMode::glass;
  });
}

void SceneBuffers::draw_glass(const Program& program) const {
  program.use();
  glBindVertexArray(vertex_array_.id());
  for (const Range& range : ranges_) {
    if (materials_[size_t(range.material)].alpha_mode != AlphaMode::glass) continue;
    bind_material(program, range.material);
    glDrawArrays(GL_TRIANGLES, range.first, range.count);
  }
  glBindVertexArray(0);
}

void SceneBuffers::visit_triangles(GLuint binding, std::initializer_list<const Program*> alpha_programs,
                                   const std::function<void(const Triangles&)>& visit) const {
  vertices_.bind_storage(binding);
  Triangles opaque{0, 0, true};
  const auto visit_opaque = [&] {
    if (opaque.count > 0) visit(opaque);
    opaque.count = 0;
  };
  for (const Range& range : ranges_) {
    const Triangles triangles{range.first / 3, range.count / 3, false};
    if (materials_[size_t(range.material)].alpha_mode == AlphaMode::opaque) {
      if (opaque.count == 0) opaque.first = triangles.first;
      opaque.count += triangles.count;
    } else {
      visit_opaque();
      for (const Program* program : alpha_programs) bind_material(*program, range.material);
      visit(triangles);
    }
  }
  visit_opaque();
}

size_t SceneBuffers::triangle_count() const { return triangles_; }
size_t SceneBuffers::bytes() const { return vertices_.bytes() + texture_bytes_; }
const std::vector<Material>& SceneBuffers::materials() const { return materials_; }

}  // namespace volgi::gl
