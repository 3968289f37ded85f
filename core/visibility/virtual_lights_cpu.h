#pragma once
#include <vector>

#include "core/emitter_points.h"
#include "core/visibility/embree_scene.h"
#include "shaders/shared/virtual_light.shared.h"

namespace volgi {

/// Reflected lights first, in the order of the scene's lights, then those on emissive surfaces.
struct VirtualLightsCpu {
  std::vector<shared::VirtualLight> lights;
  int reflected = 0;
  int emitted() const { return int(lights.size()) - reflected; }
};

/// Virtual point lights without GL: twin of screen/lights/rsm/virtual_lights with Sampling::halton, which looks the
/// same samples up in reflective shadow maps. Rays meet surfaces where they are; maps know them to a texel, so that the
/// two differ at silhouettes, at edges of albedo and in texture detail. BLEND surfaces stop a ray with probability
/// alpha (hashed). Flux and area: docs/conventions.md#virtual-lights; Cochran and Steele 2007, §3.1. Cost: one ray a
/// light, in parallel; the result does not depend on threads.
/// @param emitters  of embree.scene().
/// @param count     of all sources together, shared by power (core/light_shares.h); at least 1.
/// @param along_curve  lights of a source in the order of a curve through what it sends (core/hilbert.h), neighbours
///   beside each other, so that every n-th of them is an even choice; else in the order of Halton's points.
VirtualLightsCpu virtual_lights_cpu(const EmbreeScene& embree, const EmitterPoints& emitters, int count,
                                    bool along_curve = false);

}  // namespace volgi
