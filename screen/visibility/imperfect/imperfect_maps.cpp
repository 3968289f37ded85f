#include "screen/visibility/imperfect/imperfect_maps.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "shaders/screen/visibility/imperfect/slots.shared.h"

namespace volgi::screen {

namespace {

constexpr size_t kGroup = 128;  // GROUP of imperfect_maps.comp.glsl

const ImperfectMapOptions& checked(const ImperfectMapOptions& options) {
  if (options.texels != 16 && options.texels != 32 && options.texels != 64)
    throw Error(ExitCode::usage, fmt::format("imperfect.map: 16, 32 or 64 texels, not {}", options.texels));
  return options;
}

}  // namespace

ImperfectMaps::ImperfectMaps(const Scene& scene, const ImperfectMapOptions& options)
    : options_(checked(options)),
      points_(scene, 1 << ImperfectMapOptions::kPoolLog2),
      program_(gl::Program::compute("screen/visibility/imperfect/imperfect_maps.comp.glsl",
                                    {fmt::format("MAP_TEXELS {}", options.texels)})) {
  upload();
}

void ImperfectMaps::follow(const Scene& scene) {
  points_.follow(scene);
  upload();
}

void ImperfectMaps::upload() { gl::put(points_gl_, points_.points()); }

void ImperfectMaps::run(const gl::Buffer& views, int count, const gl::Texture& distances, int tiles,
                        float scene_diagonal_m, gl::PassTimer& timer) const {
  const auto scope = timer.scope(name);
  // A light in the air may hang outside the scene, as far off as that is large.
  constexpr float outside = 4.0f;
  program_.set("maps", count);
  program_.set("tiles", tiles);
  program_.set("all_points", 1 << ImperfectMapOptions::kPoolLog2);
  program_.set("points_of_map", 1 << options_.points_log2);
  program_.set("farthest_m", std::max(outside * scene_diagonal_m, 1e-20f));
  program_.set("pull_levels", options_.pull_levels);
  views.bind_storage(MAP_VIEWS_SLOT);
  points_gl_.bind_storage(OCCLUDER_POINTS_SLOT);
  distances.bind_image(IMPERFECT_DISTANCE_IMAGE, GL_WRITE_ONLY);
  program_.use();
  gl::dispatch_linear(size_t(count) * kGroup, kGroup);
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
}

}  // namespace volgi::screen
