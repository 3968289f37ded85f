#pragma once
#include <functional>
#include <initializer_list>
#include <map>
#include <vector>

#include "core/gl/objects.h"
#include "core/gl/program.h"
#include "core/scene.h"

namespace volgi::gl {

/// The scene on the GPU: one vertex buffer of unshared triangle corners (so that every triangle has its own geometric
/// normal and id), materials, textures with mipmaps and samplers. Draws are grouped by material.
/// Vertex attributes: 0 position vec3, 1 shading normal vec3, 2 uv0 vec2, 3 uv1 vec2, 4 color vec4,
/// 5 geometric normal vec3 (unit, front side; flat), 6 object id uint (flat).
class SceneBuffers {
 public:
  explicit SceneBuffers(const Scene& scene);

  /// The geometry of a scene that has moved, into the buffers that there are; what does not fit gets a fifth more room
  /// than it needs. Materials, textures and images must be those of the constructor's scene: they are not looked at.
  /// Cost: writes and uploads 216 bytes a triangle.
  void set_geometry(const Scene& scene);

  /// Materials of the same textures and alpha modes with other factors, such as what they emit.
  void set_materials(const std::vector<Material>& materials) { materials_ = materials; }

  /// Draws everything with `program`, which must include shared/material.glsl: per material it sets the material
  /// uniforms and binds texture units 0 (base colour), 1 (metallic), 2 (emissive), 3 (normal). Skips meshes without
  /// triangles.
  void draw(const Program& program) const;
  /// Likewise, what is of glass alone.
  void draw_glass(const Program& program) const;
  bool has_glass() const;

  /// Of pictures that are averaged each has another one, evenly spread over [0, 1): what BLEND covers by chance is then
  /// covered in its share of them.
  void set_sample(float sample) { sample_ = sample; }

  /// Triangles [first, first + count) of the vertex buffer.
  struct Triangles {
    GLint first;
    GLsizei count;
    bool opaque;
  };
  /// For compute shaders that read vertices as storage (shared/scene_vertex.shared.h): binds them at `binding` and
  /// visits all triangles. Neighbouring opaque materials come together; before the triangles of one that is not, it is
  /// set on `alpha_programs` as draw() does.
  void visit_triangles(GLuint binding, std::initializer_list<const Program*> alpha_programs,
                       const std::function<void(const Triangles&)>& visit) const;
  size_t triangle_count() const;
  size_t bytes() const;  // GPU memory
  const std::vector<Material>& materials() const;

 private:
  struct Range {
    int material;
    GLint first;
    GLsizei count;
  };
  void bind_material(const Program& program, int material) const;
  void bind_use(const Program& program, GLuint unit, const TextureUse& use, bool srgb, const char* texcoord_name,
                const char* transform_name) const;
  std::vector<Material> materials_;
  std::vector<Range> ranges_;
  std::vector<Texture> textures_;  // one for each (glTF texture, srgb) pair in use
  std::map<std::pair<int, bool>, size_t> texture_of_;
  Buffer vertices_;
  VertexArray vertex_array_;
  float sample_ = 0.0f;
  size_t triangles_ = 0;
  size_t texture_bytes_ = 0;
};

}  // namespace volgi::gl
