#version 450 core
// The coarse and fine sub-lights of every virtual light of one source.
#include "screen/lights/resample/slots.shared.h"
#include "shared/global_index.shared.h"
#include "shared/group_sizes.shared.h"
#include "shared/hilbert.shared.h"
#include "shared/near_light.shared.h"
#include "shared/octahedral.glsl"
#include "screen/lights/rsm/virtual_light_sample.glsl"

layout(local_size_x = LINEAR_GROUP) in;
layout(std430, binding = DIVIDED_CANDIDATES_SLOT) readonly buffer Candidates { VirtualLight candidate_lights[]; };
// Of the candidates of the source, from 0.
layout(std430, binding = DIVIDED_RANGES_SLOT) readonly buffer Ranges { vec2 ranges[]; };
layout(std430, binding = MADE_SUBLIGHTS_SLOT) writeonly buffer SubLights { SubLight sublights[]; };
layout(std430, binding = MADE_NEAR_LIGHTS_SLOT) writeonly buffer NearLights { NearLight near_lights[]; };
uniform int first_candidate;
uniform int candidate_count;
uniform int along_curve;  // 1: sub-lights are new samples; 0: the nearest candidates
uniform float measure;    // of all candidates
uniform int apart;        // 1: sub-lights of several surfaces are not summed

VirtualLight fine_sublight_at(ReflectiveShadowLight l, vec2 range, int k) {
  float share = (range.y - range.x) / float(FINE_SUBLIGHTS);
  float at = mix(range.x, range.y, (float(k) + 0.5) / float(FINE_SUBLIGHTS));
  if (at > float(candidate_count)) at -= float(candidate_count);
  if (along_curve != 0) {
    vec2 place = hilbert_point(uint(clamp(at / float(candidate_count), 0.0, 0.9999999) * 4294967296.0));
    return sample_place(l, place, measure * share / float(candidate_count));
  }
  VirtualLight fine = candidate_lights[first_candidate + clamp(int(at), 0, candidate_count - 1)];
  fine.flux *= share;
  fine.area_m2 *= share;
  return fine;
}

SubLight sublight(vec3 position, float area_m2, vec3 flux, vec3 normal) {
  return SubLight(position, area_m2, flux, packSnorm2x16(octahedral_encode(normal)));
}

void include_sublight(inout NearLight near, inout bool flat_light, VirtualLight fine) {
  vec3 d = fine.position - near.position;
  near.spread_m = max(near.spread_m, length(d));
  near.rise_m = min(near.rise_m, dot(d, near.normal));
  flat_light = flat_light && dot(fine.normal, near.normal) > 0.9999;
}

// How far fine sub-lights lie from the first one, and the least cosine of their normals with its.
struct Extent {
  vec3 position, normal;
  float squared, cosine;
};

void extend(inout Extent extent, VirtualLight fine) {
  vec3 d = fine.position - extent.position;
  extent.squared = max(extent.squared, dot(d, d));
  extent.cosine = min(extent.cosine, dot(fine.normal, extent.normal));
}

// Four in a square of their area lie within half of it, squared. The mean of those on both sides of an edge, or on a box
// and on the floor behind, lies in the air, and lights what none of them sees.
bool of_one_surface(Extent extent, float area_m2) { return extent.squared < 2.0 * area_m2 && extent.cosine > 0.9; }

#define NO_COARSE_M2 1e30  // every point is so near to such a sub-light that its fine ones light it

void main() {
  int i = int(global_index());
  if (i >= count) return;
  ReflectiveShadowLight l = rsm_lights[max(light, 0)];
  VirtualLight all = virtual_lights[first + i];
  NearLight near = NearLight(all.position, all.area_m2, all.normal, 0.0, 0.0, 0.0, 0.0, 0.0);
  bool flat_light = true;
  int first_sublight = (first + i) * SUBLIGHTS_PER_LIGHT;
  for (int coarse = 0; coarse < COARSE_SUBLIGHTS; ++coarse) {
    // The mean by flux, which nothing can hide: sub-lights have no visibility of their own.
    vec3 position = vec3(0.0), normal = vec3(0.0), flux = vec3(0.0);
    float area_m2 = 0.0, weight = 0.0;
    Extent extent = Extent(vec3(0.0), vec3(0.0), 0.0, 1.0);
    const int fine_per_coarse = FINE_SUBLIGHTS / COARSE_SUBLIGHTS;
    for (int k = coarse * fine_per_coarse; k < (coarse + 1) * fine_per_coarse; ++k) {
      VirtualLight fine = fine_sublight_at(l, ranges[first + i], k);
      sublights[first_sublight + COARSE_SUBLIGHTS + k] = sublight(fine.position, fine.area_m2, fine.flux, fine.normal);
      if (fine.flux == vec3(0.0)) continue;
      include_sublight(near, flat_light, fine);
      if (weight == 0.0) extent = Extent(fine.position, fine.normal, 0.0, 1.0);
      extend(extent, fine);
      float w = fine.flux.r + fine.flux.g + fine.flux.b;
      position += w * fine.position;
      normal += w * fine.normal;
      weight += w;
      flux += fine.flux;
      area_m2 += fine.area_m2;
    }
    bool dark = weight <= 0.0;  // and then anywhere
    if (apart != 0 && !of_one_surface(extent, area_m2)) area_m2 = NO_COARSE_M2;
    sublights[first_sublight + coarse] = sublight(dark ? all.position : position / weight, area_m2, flux,
                                          dark ? all.normal : normalize(normal));
  }
  // What is lower over a flat light than a thousandth of its edge sees it at a cosine under that: left out, or every
  // pixel of the light's own plane would be looked at. Normals within 0.8 degrees count as one.
  near.rise_m = flat_light ? near.rise_m + 1e-3 * sqrt(all.area_m2) : -3.0e38;
  near_lights[first + i] = near;
}
