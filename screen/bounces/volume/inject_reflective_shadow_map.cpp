#include "screen/bounces/volume/inject_reflective_shadow_map.h"

#include "screen/bounces/volume/largest_power.h"
#include "shaders/shared/group_sizes.shared.h"

namespace volgi::screen {

InjectReflectiveShadowMap::InjectReflectiveShadowMap()
    : program_(gl::Program::compute("screen/bounces/volume/inject_reflective_shadow_map.comp.glsl")) {}

void InjectReflectiveShadowMap::run(const VoxelGridGl& voxels, const ReflectiveShadowMap& maps, const Scene& scene,
                                    SideFluxGl& flux, gl::PassTimer& timer) {
  if (maps.light_count() == 0) return;
  auto scope = timer.scope(name);
  for (int light = 0; light < maps.light_count(); ++light) {
    flux.begin_source(voxels, program_, largest_power(scene.lights[size_t(light)], scene.bounds_min, scene.bounds_max));
    maps.bind(light);
    program_.use();
    program_.set("light", light);
    program_.set("resolution", maps.resolution(light));
    int threads = (maps.resolution(light) + 3) / 4;
    gl::dispatch({threads, threads, maps.layer_count(light)}, {SQUARE_GROUP, SQUARE_GROUP, 1});
    flux.collect(voxels, flux.punctual());
  }
}

}  // namespace volgi::screen
