#include "reference/virtual_light_tracer.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "reference/picture_layers.h"

namespace volgi {
namespace {

constexpr double kPi = std::numbers::pi;

// How wrong a light's position may be, relative to the longest edge of the scene. A rasterizer snaps vertices to 1/256
// of a texel and then extends a triangle's plane to the texel's centre: in a map of N texels across the scene a light
// is up to 1/(256 N) of it behind the surface in front, 0.8e-5 at N = 512; depth's own rounding, 2^-23, is less.
constexpr double kPositionError = 1e-5;
// In such errors. Rays aim above the light: one error undoes the light's own, one keeps clear of its surface at any
// angle, which an end before the light would not.
constexpr double kLift = 2.0;
// Rays end before the point they aim at: in a corner a light may lie one error behind the other wall, whose crossing
// then does not count where the ray meets that wall with a cosine above 1/8. Measured in a test.
constexpr double kEnd = 8.0;

// A light of the list in the scene's frame, ready for the sum.
struct GatheredLight {
  glm::dvec3 position;
  glm::dvec3 normal;
  glm::dvec3 flux;
  glm::dvec3 aim;  // of shadow rays
  double area_m2;
  std::uint32_t index;  // in the list
  bool indirect;
  bool in_the_air;  // of a lattice
};

double position_error(const Scene& scene) {
  const glm::dvec3 edge = glm::dvec3(scene.bounds_max) - glm::dvec3(scene.bounds_min);
  return kPositionError * std::max({edge.x, edge.y, edge.z});
}

std::vector<GatheredLight> lights_of(const VirtualLightList& list, const Scene& scene, bool with_indirect) {
  const glm::dvec3 shift = list.world_origin - scene.world_origin;
  const double lift = kLift * position_error(scene);
  std::vector<GatheredLight> out;
  out.reserve(list.lights.size());
  for (size_t i = 0; i < list.lights.size(); ++i) {
    const shared::VirtualLight& light = list.lights[i];
    const bool in_the_air = light.kind == VIRTUAL_LIGHT_LATTICE;
    const bool indirect = light.kind == VIRTUAL_LIGHT_REFLECTED || in_the_air;
    if (light.kind == VIRTUAL_LIGHT_NEGATIVE || light.flux == glm::vec3(0.0f) || (indirect && !with_indirect)) continue;
    const glm::dvec3 position = glm::dvec3(light.position) + shift, normal(light.normal);
    const glm::dvec3 aim = in_the_air ? position : position + lift * normal;
    out.push_back({position, normal, glm::dvec3(light.flux), aim, double(light.area_m2), static_cast<std::uint32_t>(i),
                   indirect, in_the_air});
  }
  return out;
}

// Form factor from a point to a disk of the radius r, over its area [m^-2]: a parallel point (Howell, B-13) and an
// upright one that is turned to the axis (B-14), in the shares of the point's own normal. The point is `height` over
// the disk's plane; the disk's middle is `along` over the point's horizon.
double disk_to_point(double height, double along, double facing, double squared, double area_m2) {
  const double r2 = area_m2 / kPi, lift = std::min(height, along);
  const double apart =
      std::clamp(1e6 * lift * lift / std::max(r2, 1e-300) - 1.0, 0.0, 1.0);  // 0: both lie in one plane
  if (r2 < 1e-9 * squared) return height * along / (kPi * squared * squared);
  const double across = 2.0 * std::sqrt(r2 * std::max(squared - height * height, 0.0)), sum = squared + r2;
  const double root = std::sqrt(std::max((sum - across) * (sum + across), 0.0));
  if (!(root > 0.0)) return 0.5 * std::max(facing, 0.0) / area_m2;  // on the rim
  const double parallel = 0.5 * (1.0 - (squared - r2) / root);
  const double upright = 2.0 * height * r2 / (root * (sum + root));  // over the distance from the axis
  return apart * std::clamp(facing * parallel + (along - facing * height) * upright, 0.0, 1.0) / area_m2;
}

// Irradiance at the vertex per unit of flux, as if nothing were in between.
double irradiance_per_flux(const PathVertex& vertex, const GatheredLight& light) {
  const glm::dvec3 between = light.position - glm::dvec3(vertex.surface.position);
  const double squared = glm::dot(between, between);
  const double at_light = -glm::dot(light.normal, between);
  const double at_vertex = glm::dot(glm::dvec3(vertex.shading_normal), between);
  // Both normals of the vertex decide which side light is on; also nothing where the two points are one.
  if (light.in_the_air) {  // an intensity I ahead and I / 2 back: 3 pi I of flux
    if (!(at_vertex > 0.0) || !(glm::dot(glm::dvec3(vertex.geometric_normal), between) > 0.0)) return 0.0;
    return (at_light > 0.0 ? 1.0 : 0.5) * at_vertex / std::sqrt(squared) / (3.0 * (kPi * squared + light.area_m2));
  }
  if (!(at_light > 0.0) || !(at_vertex > 0.0) || !(glm::dot(glm::dvec3(vertex.geometric_normal), between) > 0.0))
    return 0.0;
  const double facing = -glm::dot(light.normal, glm::dvec3(vertex.shading_normal));
  return disk_to_point(at_light, at_vertex, facing, squared, light.area_m2);
}

struct GatheredRadiance {
  glm::dvec3 direct{0.0};
  glm::dvec3 indirect{0.0};
};

class PictureGather {
 public:
  PictureGather(const Scene& scene, const PathIntegrator& integrator, const Camera& camera,
                const VirtualLightList& list, const VirtualLightGatherOptions& options)
      : scene_(scene),
        integrator_(integrator),
        camera_(camera),
        options_(options),
        lights_(lights_of(list, scene, options.light != PathTracerOptions::Light::direct)),
        ray_end_(kEnd * position_error(scene)),
        picture_(empty_picture(options.size, options.light)) {}

  void gather_pixel(int x, int y) {
    const CameraRay ray = camera_ray(camera_, glm::vec2(x, y) + 0.5f, options_.size);
    PathVertex vertex;
    const std::uint32_t pixel =
        static_cast<std::uint32_t>(y) * static_cast<std::uint32_t>(options_.size.x) + static_cast<std::uint32_t>(x);
    const std::uint32_t seed = hash(options_.seed, pixel);
    if (!integrator_.first_vertex(ray, hash(seed, 0), vertex)) return;
    write_first_hit(picture_, {x, y}, scene_, camera_, ray, vertex);
    PathSampler sampler(hash(seed, 1), 0);
    GatheredRadiance radiance;
    if (vertex.surface.albedo != glm::vec3(0.0f)) {
      radiance = sum_of_lights(vertex, hash(seed, 2));
      radiance.direct += glm::dvec3(integrator_.all_punctual(vertex, sampler));
    }
    radiance.direct += glm::dvec3(vertex.emission);
    radiance.direct *= glm::dvec3(vertex.tint);
    radiance.indirect *= glm::dvec3(vertex.tint);
    write_light(x, y, radiance);
  }

  ReferencePicture take() { return std::move(picture_); }

 private:
  glm::vec3 visible(const PathVertex& vertex, const GatheredLight& light, std::uint32_t seed) const {
    const glm::dvec3 between = light.aim - glm::dvec3(vertex.start);
    const double distance = glm::length(between);
    const double radius = std::sqrt(light.area_m2 / kPi);
    const double from = options_.blind_at_receiver * radius;
    const double end = from + ray_end_ + options_.blind_at_light * radius;
    if (!(distance > end)) return glm::vec3(1.0f);
    const glm::dvec3 way = between / distance;
    return integrator_.rays().passed({vertex.start + glm::vec3(from * way),
                                      glm::vec3(way),
                                      static_cast<float>(distance - end),
                                      hash(seed, light.index),
                                      vertex.triangle,
                                      {}});
  }

  // In the list's order, so that the sum's rounding does not depend on anything.
  GatheredRadiance sum_of_lights(const PathVertex& vertex, std::uint32_t seed) const {
    GatheredRadiance sum;
    for (const GatheredLight& light : lights_) {
      const double irradiance = irradiance_per_flux(vertex, light);
      if (irradiance <= 0.0) continue;
      glm::dvec3 arrives = irradiance * light.flux;
      if (options_.visibility == VirtualLightGatherOptions::Visibility::exact)
        arrives *= glm::dvec3(visible(vertex, light, seed));
      (light.indirect ? sum.indirect : sum.direct) += arrives;
    }
    const glm::dvec3 reflection = glm::dvec3(vertex.surface.albedo) / kPi;
    return {sum.direct * reflection, sum.indirect * reflection};
  }

  void write_light(int x, int y, const GatheredRadiance& radiance) {
    using Light = PathTracerOptions::Light;
    glm::dvec3 asked = radiance.direct + radiance.indirect;
    if (options_.light == Light::direct) asked = radiance.direct;
    if (options_.light == Light::indirect) asked = radiance.indirect;
    for (Image* image : {&picture_.color, &picture_.half_a, &picture_.half_b}) image->at(x, y) = glm::vec3(asked);
    for (Image* image : {&picture_.direct, &picture_.direct_half_a, &picture_.direct_half_b})
      image->at(x, y) = glm::vec3(radiance.direct);
  }

  const Scene& scene_;
  const PathIntegrator& integrator_;
  const Camera& camera_;
  const VirtualLightGatherOptions& options_;
  std::vector<GatheredLight> lights_;
  double ray_end_;  // [m]
  ReferencePicture picture_;
};

}  // namespace

VirtualLightTracer::VirtualLightTracer(const Scene& scene) : scene_(scene), integrator_(scene) {}

ReferencePicture VirtualLightTracer::gather(const Camera& camera, const VirtualLightList& list,
                                            const VirtualLightGatherOptions& options) const {
  assert(options.size.x > 0 && options.size.y > 0);
  PictureGather picture(scene_, integrator_, camera, list, options);
  for_each_pixel(options.size, options.threads, "reference", [&](int x, int y) { picture.gather_pixel(x, y); });
  return picture.take();
}

ReferencePicture gather_virtual_lights(const Scene& scene, const Camera& camera, const VirtualLightList& list,
                                       const VirtualLightGatherOptions& options) {
  return VirtualLightTracer(scene).gather(camera, list, options);
}

}  // namespace volgi
