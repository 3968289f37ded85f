#include <algorithm>
#include <iterator>

#include "core/scene.h"

namespace volgi {

namespace {

/// Where what was appended begins.
struct Offsets {
  int materials, textures, images;
  std::uint32_t objects;
};

Offsets offsets_of(const Scene& scene) {
  Offsets o{int(scene.materials.size()), int(scene.textures.size()), int(scene.images.size()), 0};
  for (const Mesh& mesh : scene.meshes) o.objects = std::max(o.objects, mesh.object_id);
  return o;
}

Material moved(Material material, const Offsets& by) {
  for (TextureUse* use : {&material.base_color, &material.metallic, &material.emissive, &material.normal}) {
    if (use->texture >= 0) use->texture += by.textures;
  }
  return material;
}

Mesh moved(Mesh mesh, const Offsets& by, glm::vec3 shift) {
  mesh.material += by.materials;
  mesh.object_id += by.objects;
  for (glm::vec3& p : mesh.positions) p += shift;
  return mesh;
}

}  // namespace

void append_scene(Scene& scene, const Scene& other) {
  const Offsets by = offsets_of(scene);
  const glm::vec3 shift(other.world_origin - scene.world_origin);
  const bool had_triangles = scene.triangle_count() > 0;
  for (const Material& m : other.materials) scene.materials.push_back(moved(m, by));
  for (Texture t : other.textures) {
    t.image += by.images;
    scene.textures.push_back(t);
  }
  std::copy(other.images.begin(), other.images.end(), std::back_inserter(scene.images));
  for (const Mesh& m : other.meshes) scene.meshes.push_back(moved(m, by, shift));
  for (Light light : other.lights) {
    light.position += shift;
    scene.lights.push_back(std::move(light));
  }
  for (Camera camera : other.cameras) {
    camera.world_from_camera[3] += glm::vec4(shift, 0.0f);
    scene.cameras.push_back(std::move(camera));
  }
  if (!scene.sky) scene.sky = other.sky;
  if (other.triangle_count() == 0) return;
  const glm::vec3 low = other.bounds_min + shift, high = other.bounds_max + shift;
  scene.bounds_min = had_triangles ? glm::min(scene.bounds_min, low) : low;
  scene.bounds_max = had_triangles ? glm::max(scene.bounds_max, high) : high;
}

}  // namespace volgi
