#pragma once
#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <vector>

#include "core/camera.h"
#include "core/scene.h"
#include "core/surface.h"
#include "core/visibility/embree_scene.h"
#include "reference/emitters.h"
#include "reference/sampler.h"
#include "reference/scattering.h"
#include "reference/sky_sampler.h"
#include "shaders/shared/light.shared.h"

namespace volgi {

/// A surface as a path meets it: normals turned to the side that the path came from.
struct PathVertex {
  TriangleIndex triangle;
  SurfacePoint surface;        // normals as stored, to the front
  glm::vec3 geometric_normal;  // decides which side light is on
  glm::vec3 shading_normal;    // cosines
  glm::vec3 to_viewer;         // back along the path, unit
  glm::vec3 start;             // rays leave from here (EmbreeScene::leaving_point)
  glm::vec3 emission;          // radiance towards where the path came from
  float distance = 0.0f;       // [m] from the previous vertex
  glm::vec3 tint{1.0f};        // of light on the way from the previous vertex, by glass
};

/// Radiance along a camera ray, apart as --light has it.
struct PathRadiance {
  glm::vec3 direct{0.0f};
  glm::vec3 indirect{0.0f};
};

/// Light along paths through a scene (which must outlive it), reflected on both sides of every triangle
/// (scattering.h). Each vertex gathers punctual lights by shadow rays, and emissive triangles and the sky by sampling
/// them and by the next ray of the path, weighted by the power heuristic (Veach 1997 §9.2.2). Thread-safe.
///
/// Where shading and geometric normal disagree, light must be on the viewer's side of both: none leaks through, and
/// what the hemisphere around the shading normal sends into the surface is absorbed.
class PathIntegrator {
 public:
  static constexpr int unlimited = std::numeric_limits<int>::max();

  explicit PathIntegrator(const Scene& scene);

  /// @return false where the ray meets nothing; the vertex then has its tint alone.
  bool first_vertex(const CameraRay& ray, std::uint32_t alpha_seed, PathVertex& vertex) const;
  /// What a ray sees that meets nothing.
  glm::vec3 background(glm::vec3 direction) const;
  /// All light that reaches the camera from `first`, after at most `max_bounces` reflections between it and the light.
  PathRadiance trace(const PathVertex& first, PathSampler& sampler, int max_bounces) const;
  /// True when a ray may pass a surface by chance, so that the first hit differs between samples.
  bool has_blending() const { return has_blending_; }

  /// What `vertex` reflects of every punctual light, a shadow ray each.
  glm::vec3 all_punctual(const PathVertex& vertex, PathSampler& sampler) const;
  /// Which punctual lights reach a surface, whatever it reflects of them: bit k for light k. 24 bits, which a float
  /// holds exactly; lights from 24 on share them (k mod 24). BLEND is seen through by the chance of `alpha_seed`.
  std::uint32_t lights_reaching(const PathVertex& vertex, std::uint32_t alpha_seed) const;
  const EmbreeScene& rays() const { return rays_; }
  /// Other punctual lights than the scene's, such as the same ones at another time. Not while paths are traced.
  void set_lights(const std::vector<Light>& lights);

 private:
  bool next_vertex(const Ray& ray, PathVertex& vertex) const;
  glm::vec3 punctual_light(const PathVertex& vertex, const shared::PunctualLight& light, glm::vec3& to_light,
                           float& distance) const;
  glm::vec3 visible(const PathVertex& vertex, glm::vec3 to_light, float distance, std::uint32_t alpha_seed) const;
  glm::vec3 one_punctual(const PathVertex& vertex, PathSampler& sampler) const;
  glm::vec3 emitters(const PathVertex& vertex, PathSampler& sampler) const;
  glm::vec3 sky(const PathVertex& vertex, PathSampler& sampler) const;
  glm::vec3 gather(const PathVertex& vertex, bool first, PathSampler& sampler) const;
  float emitter_weight(const PathVertex& hit, glm::vec3 direction, float pdf_direction) const;
  float sky_weight(glm::vec3 direction, float pdf_direction) const;
  bool sees_light() const { return !emitters_.empty() || scene_->sky; }  // by a path's last ray

  const Scene* scene_;
  EmbreeScene rays_;
  Emitters emitters_;
  std::vector<shared::PunctualLight> lights_;
  std::optional<SkySampler> sky_;  // none for a sky that is constant, and where there is none
  bool has_blending_ = false;
};

}  // namespace volgi
