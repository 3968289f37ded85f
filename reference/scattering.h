#pragma once
#include <glm/glm.hpp>

#include "core/surface.h"

namespace volgi {

/// How a surface point reflects: glTF 2.0, appendix B. A Lambertian part weighed by what Fresnel leaves it, and GGX
/// with height-correlated Smith masking and Schlick's Fresnel. Single scattering, as there. Or, where the
/// surface says so, a Phong lobe that keeps power, f0 (n + 2) / 2 pi (R.l)^n (Lafortune and Willems 1994), without
/// Fresnel. Written apart from the
/// renderers' (shaders/screen/base/brdf.glsl), so that one finds the other's mistakes.
/// Directions are unit and point away from the surface; `normal` is the shading normal on the viewer's side.
class Scattering {
 public:
  explicit Scattering(const SurfacePoint& surface);

  bool black() const { return diffuse_ == glm::vec3(0.0f) && !shines(); }
  /// The reflectance distribution [1/sr] times the cosine of `to_light`; 0 below the horizon.
  glm::vec3 reflected(glm::vec3 normal, glm::vec3 to_viewer, glm::vec3 to_light) const;
  /// Density per solid angle with which sample() chooses `to_light`.
  float pdf(glm::vec3 normal, glm::vec3 to_viewer, glm::vec3 to_light) const;
  /// A direction to go on, in proportion to one of the two parts. @param xi  uniform; `choice` chooses the part.
  glm::vec3 sample(glm::vec3 normal, glm::vec3 to_viewer, glm::vec2 xi, float choice) const;

 private:
  bool shines() const { return f90_ > 0.0f; }
  float mirror_share(glm::vec3 normal, glm::vec3 to_viewer) const;  // of samples

  glm::vec3 diffuse_, f0_;
  float f90_, alpha_;
  float exponent_;  // of a Phong lobe; < 0: GGX
};

}  // namespace volgi
