// Directions through a pixel's lobe and what they meet of emissive surfaces: Nichols 2010, sections 5.3.2.1 and
// 5.3.3.3.
// Set by the program: PHONG, where mirrors are Phong lobes
#ifndef VOLGI_LOBE_SAMPLES_GLSL
#define VOLGI_LOBE_SAMPLES_GLSL
#include "screen/base/lobe.glsl"
#include "screen/gather/area/area_level.glsl"
#include "screen/gather/area/emission_panel.shared.h"
#include "shared/virtual_light.shared.h"

layout(binding = GBUFFER_DIFFUSE_UNIT) uniform sampler2D diffuse_map;
layout(binding = GBUFFER_MIRROR_UNIT) uniform sampler2D mirror_map;
layout(std430, binding = AREA_LIGHTS_SLOT) readonly buffer AreaLights { VirtualLight area_lights[]; };
layout(std430, binding = AREA_PANELS_SLOT) readonly buffer Panels { EmissionPanel panels[]; };
uniform int panel_count;
uniform vec4 viewer;  // position and 1, or the direction towards an orthographic camera and 0

#define LOBE_SAMPLES 24  // of 5 x 5, but for one corner
#define LOBE_NONE 0u
#define LOBE_WIDE 1u    // by lights
#define LOBE_NARROW 2u  // by samples
#define FEWEST_LIGHTS 9
#define LEAST_OF_LOBE 0.1  // (R.l)^n of what lies in it

struct Receiver {
  vec3 position, geometric;
  Lobe lobe;
  float apart;  // share of the mirror that albedo leaves out
};

// False: nothing there has its mirror apart.
bool receiver_at(ivec2 pixel, out Receiver r) {
  vec4 position = texelFetch(position_map, pixel, 0), normals = texelFetch(normal_map, pixel, 0);
  r.position = position.xyz;
  r.geometric = octahedral_decode(normals.zw);
  r.lobe = lobe_of(octahedral_decode(normals.xy), normalize(viewer.xyz - position.xyz * viewer.w),
                   texelFetch(mirror_map, pixel, 0), texelFetch(diffuse_map, pixel, 0).a);
  r.apart = position.w == 0.0 ? 0.0 : 1.0 - texelFetch(albedo_map, pixel, 0).a;
  return r.apart > 0.0;
}

struct LobeSample {
  vec3 direction;
  float solid_angle;
};

// The k-th of an even grid on the plane across the mirrored direction. Of a lobe cos^n, about a Gaussian of variance
// 1 / n, a grid of 1.1 standard deviations sums all but a thousandth where light is even.
LobeSample lobe_sample(Lobe s, mat3 frame, int k) {
  float spacing = min(1.1 * inversesqrt(s.exponent + 1.0), 0.35);
  vec2 off = spacing * vec2(k % 5 - 2, k / 5 - 2);
  float squared = 1.0 + dot(off, off);
  return LobeSample(frame * vec3(off, 1.0) * inversesqrt(squared),
                    spacing * spacing * inversesqrt(squared) / squared);
}

struct PanelHit {
  int panel;  // -1: none
  float distance_m;
  vec2 uv;
  float cosine;
};

// A quarter of the panel's size beyond its edges counts: there its coarser pictures end.
PanelHit panel_along(vec3 from, vec3 direction) {
  PanelHit hit = PanelHit(-1, 3.0e38, vec2(0.0), 0.0);
  for (int k = 0; k < panel_count; ++k) {
    EmissionPanel p = panels[k];
    float cosine = -dot(direction, p.normal), height = dot(from - p.corner, p.normal);
    if (min(cosine, height) <= 0.0) continue;
    float distance_m = height / cosine;
    vec3 at = from + distance_m * direction - p.corner;
    vec2 uv = vec2(dot(at, p.u_per_m), dot(at, p.v_per_m));
    if (distance_m < hit.distance_m && all(greaterThan(uv, vec2(-0.25))) && all(lessThan(uv, vec2(1.25))))
      hit = PanelHit(k, distance_m, uv, cosine);
  }
  return hit;
}

// Which of four samples that follow on one another a pixel of a block of 2 x 2 asks for.
int sample_of(ivec2 pixel) { return (pixel.x & 1) + 2 * (pixel.y & 1); }

#endif
