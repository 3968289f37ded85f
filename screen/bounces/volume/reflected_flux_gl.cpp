#include "screen/bounces/volume/reflected_flux_gl.h"

#include <algorithm>

#include "screen/bounces/volume/largest_power.h"
#include "shaders/screen/base/slots.shared.h"
#include "shaders/screen/bounces/volume/slots.shared.h"
#include "shaders/shared/group_sizes.shared.h"
#include "shaders/shared/near_light.shared.h"

namespace volgi::screen {

ReflectedFluxGl::ReflectedFluxGl(const Scene& scene)
    : program_(gl::Program::compute("screen/bounces/volume/reflected_flux.comp.glsl")) {
  follow(scene);
}

void ReflectedFluxGl::follow(const Scene& scene) {
  reflected_power_ = largest_reflected_power(scene);
  emitted_power_ = largest_emitted_power(scene);
}

void ReflectedFluxGl::run(const VoxelGridGl& voxels, const FirstBounce& first_bounce, SideFluxGl& flux,
                          gl::PassTimer& timer) {
  const auto scope = timer.scope(name);
  const VirtualLightListGl& lights = first_bounce.lights;
  const bool in_parts = first_bounce.subdivision != nullptr;
  const int senders_per_light = in_parts ? FINE_SUBLIGHTS : 1;
  const int rays = std::max(kRays / std::max(lights.count() * senders_per_light, 1), 1);
  program_.set("in_parts", in_parts ? 1 : 0);
  program_.set("rays_per_sender", rays);
  const auto send = [&](int first, int count, float power, const gl::Buffer& into) {
    if (count == 0) return;
    flux.begin_source(voxels, program_, power);
    lights.buffer.bind_storage(VIRTUAL_LIGHTS_SLOT);
    (in_parts ? first_bounce.subdivision->sublights() : lights.buffer).bind_storage(SENDERS_SLOT);
    const int threads = count * senders_per_light * rays;
    program_.set("first_sender", first * senders_per_light);
    program_.set("ray_count", threads);
    program_.set("first_ray", GLuint(first_bounce.sample) * GLuint(threads));
    program_.use();
    gl::dispatch_linear(size_t(threads), LINEAR_GROUP);
    flux.collect(voxels, into);
  };
  send(0, lights.reflected, reflected_power_, flux.punctual());
  send(lights.reflected, lights.emitted, emitted_power_, flux.emitted());
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
}

}  // namespace volgi::screen
