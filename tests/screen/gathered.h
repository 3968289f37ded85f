#pragma once
// Virtual lights placed by hand, their gather on a scene's G-buffer, and the same sums in double precision.
#include <cmath>
#include <cstring>
#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>
#include <vector>

#include "screen/gather/strided/virtual_light_gather.h"
#include "tests/screen/screen_scene.h"
#include "tests/support/disk_to_point.h"

namespace volgi::test {

using screen::GatherOptions;
using screen::VirtualLightGather;
using screen::VirtualLightListGl;
using shared::VirtualLight;

inline VirtualLight light_at(glm::vec3 position, glm::vec3 normal, glm::vec3 flux = glm::vec3(1.0f),
                             float area_m2 = 1e-4f, int kind = VIRTUAL_LIGHT_REFLECTED) {
  return {position, area_m2, glm::normalize(normal), kind, flux, kind == VIRTUAL_LIGHT_EMITTED ? -1 : 0};
}

inline VirtualLightListGl list_of(std::vector<VirtualLight> reflected, const std::vector<VirtualLight>& emitted = {}) {
  VirtualLightListGl list;
  list.reflected = int(reflected.size());
  list.emitted = int(emitted.size());
  list.of_light = {list.reflected};
  reflected.insert(reflected.end(), emitted.begin(), emitted.end());
  reflected.resize(padded_count(list));
  list.buffer = gl::Buffer(reflected);
  return list;
}

inline std::vector<glm::vec4> texels(const gl::Texture& texture) {
  const std::vector<float> values = texture.download(4);
  std::vector<glm::vec4> out(values.size() / 4);
  std::memcpy(out.data(), values.data(), values.size() * sizeof(float));
  return out;
}

/// A scene's G-buffer, on the GPU and as the CPU reads it.
struct Seen {
  Seen(const gl::Context& context, const Scene& scene, const Camera& from, glm::ivec2 picture_size)
      : camera(from), size(picture_size), gbuffer(size), timer(context.software(), false) {
    diagonal_m = glm::distance(scene.bounds_min, scene.bounds_max);
    const gl::SceneBuffers buffers(scene);
    gbuffer.run(buffers, camera, timer);
    position = texels(gbuffer.position());
    normals = texels(gbuffer.normals());
    albedo = texels(gbuffer.albedo());
  }

  static glm::dvec3 decoded(glm::dvec2 v) {
    glm::dvec3 n(v, 1.0 - std::abs(v.x) - std::abs(v.y));
    if (n.z < 0.0) {
      n.x = (1.0 - std::abs(v.y)) * (v.x >= 0.0 ? 1.0 : -1.0);
      n.y = (1.0 - std::abs(v.x)) * (v.y >= 0.0 ? 1.0 : -1.0);
    }
    return glm::normalize(n);
  }
  glm::dvec3 normal(size_t i) const { return decoded({normals[i].x, normals[i].y}); }
  glm::dvec3 geometric(size_t i) const { return decoded({normals[i].z, normals[i].w}); }

  Camera camera;
  glm::ivec2 size;
  screen::GBuffer gbuffer;
  gl::PassTimer timer;
  float diagonal_m = 0.0f;
  std::vector<glm::vec4> position, normals, albedo;  // row 0 at the bottom
};

struct Gathered {
  std::vector<glm::vec4> direct, indirect;  // row 0 at the bottom
  float coarse_share = 0.0f;
};

inline Gathered gathered(Seen& seen, const VirtualLightListGl& lights, const GatherOptions& options,
                         const screen::NegativeLights* negative = nullptr,
                         VirtualLightGather::Part part = VirtualLightGather::Part::all) {
  VirtualLightGather gather(seen.size, options);
  gather.run(seen.gbuffer, lights, {.negative = negative}, part, seen.diagonal_m, seen.timer);
  return {texels(gather.direct()), texels(gather.indirect()), gather.coarse_share()};
}

inline GatherOptions every_pixel() {
  GatherOptions o;
  o.stride = 1;
  return o;
}

/// What one light gives a pixel, no visibility: docs/conventions.md#virtual-lights.
inline glm::dvec3 irradiance_of(const VirtualLight& light, const Seen& seen, size_t pixel) {
  const glm::dvec3 w = glm::dvec3(light.position) - glm::dvec3(seen.position[pixel]);
  if (glm::dot(w, seen.geometric(pixel)) <= 0.0) return glm::dvec3(0.0);
  return glm::dvec3(light.flux) * disk_to_point_exact(seen.position[pixel], seen.normal(pixel), light.position,
                                                      light.normal, double(light.area_m2));
}

inline glm::dvec3 radiance_of(const std::vector<VirtualLight>& lights, const Seen& seen, size_t pixel) {
  if (seen.position[pixel].w == 0.0f) return glm::dvec3(0.0);
  glm::dvec3 sum(0.0);
  for (const VirtualLight& l : lights) sum += irradiance_of(l, seen, pixel);
  return sum * glm::dvec3(seen.albedo[pixel]) / glm::pi<double>();
}

}  // namespace volgi::test
