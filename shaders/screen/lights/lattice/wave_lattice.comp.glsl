#version 450 core
// The lights of one primary light's lattice, those that are on. docs/theory.md#wave-lattice.
#include "shared/constants.glsl"
#include "shared/global_index.shared.h"
#include "shared/group_sizes.shared.h"
#include "shared/reflective_shadow_map.glsl"
#include "shared/virtual_light.shared.h"
#include "screen/lights/lattice/lattice_sums.glsl"

layout(local_size_x = LINEAR_GROUP) in;
layout(std430, binding = LATTICE_LIGHTS_SLOT) writeonly buffer Lights { VirtualLight virtual_lights[]; };
layout(std430, binding = LATTICE_ON_SLOT) readonly buffer On { int on[]; };  // of the lattice: ray * shells + shell
uniform int light;
uniform int first;     // where the lattice begins among the virtual lights of all
uniform int first_on;  // and among those that are on
uniform int count;     // that are on
uniform int rays;
uniform int about_count;  // rays in a circle about the axis
uniform float step;       // between circles [rad]
uniform int across;       // a sun's rays: across x across
uniform mat3 world_from_axis;  // turns -Y to the light's axis
uniform int shells;
uniform float farthest_shell;
uniform float growth;
uniform float attenuation;
uniform int depth_by_ray;
uniform int conserving;
uniform float on_share;              // of all lights; those stand for the others
uniform vec3 surface_albedo;         // mean of the scene
uniform int later_bounces;           // that the lattice stands for, besides the first; -1: all
uniform float factor[LATTICE_MAX_SHELLS];

struct Ray {
  vec3 origin, direction;
  float area_per_squared;  // of the part of a shell that a light stands for, over the squared distance; of a sun the area
};

Ray sun_ray(ReflectiveShadowLayer view, int resolution, int ray) {
  float inner = 1.0 - 2.0 * float(RSM_MARGIN_TEXELS) / float(resolution);
  vec2 uv = ((vec2(ray % across, ray / across) + 0.5) * (2.0 / float(across)) - 1.0) * inner;
  vec3 aside = view.right * (uv.x * view.extent_x) + view.up * (uv.y * view.extent_y);
  return Ray(view.origin + aside, view.forward, 4.0 * inner * inner * view.extent_x * view.extent_y / float(rays));
}

Ray ray_of(ReflectiveShadowLight l, int ray) {
  if (l.light.type == LIGHT_DIRECTIONAL) return sun_ray(rsm_layers[l.first_layer], l.resolution, ray);
  vec2 angles = lattice_angles(ray, about_count, step);
  vec3 turned = vec3(sin(angles.x) * cos(angles.y), -cos(angles.x), sin(angles.x) * sin(angles.y));
  float whole = l.light.type == LIGHT_POINT ? 4.0 * PI : 2.0 * PI;
  return Ray(l.light.position, world_from_axis * turned, whole / float(rays));
}

// How far the ray goes until it meets a surface; the scene's depth where the map does not show that.
float depth_along(ReflectiveShadowLight l, Ray ray, float scene_m) {
  vec3 at = ray.origin + ray.direction;
  int layer = rsm_layer_of_direction(l.layer_count, ray.direction);
  ReflectiveShadowLayer view = rsm_layers[l.first_layer + layer];
  vec3 uvz = rsm_uvz_from_position(view, at);
  if (uvz.z <= 0.0 || max(abs(uvz.x), abs(uvz.y)) >= 1.0) return scene_m;
  ivec2 texel = clamp(ivec2(floor((uvz.xy * 0.5 + 0.5) * float(l.resolution))), ivec2(0), ivec2(l.resolution - 1));
  float depth = texelFetch(rsm_depth, ivec3(texel, layer), 0).r;
  if (depth <= 0.0) return scene_m;
  float z = rsm_z_from_depth(view, depth);
  return view.directional != 0 ? z : z / max(dot(ray.direction, view.forward), 1e-30);
}

// The power of all bounces over that of the first: each meets as much of what it sends as the light does, and reflects
// the mean albedo of it.
vec3 all_bounces(vec3 sent, vec3 met) {
  vec3 again = min(surface_albedo * met / max(sent, vec3(1e-30)), vec3(0.999));
  if (later_bounces < 0) return 1.0 / (1.0 - again);
  vec3 sum = vec3(1.0), power = vec3(1.0);
  for (int bounce = 0; bounce < later_bounces; ++bounce) {
    power *= again;
    sum += power;
  }
  return sum;
}

vec3 flux_of(int shell) {
  vec3 sent = vec3(0.0), met = vec3(0.0), reflected = vec3(0.0);
  for (int g = 0; g < LATTICE_GROUPS; ++g) {
    sent += sums[g].sent.rgb;
    met += sums[g].met.rgb;
    // Along rays of their own length, all of it meets surfaces behind the last shell: each gets as much.
    if (depth_by_ray == 0) reflected += sums[g].reflected[shell].rgb;
    else for (int s = 0; s < shells; ++s) reflected += sums[g].reflected[s].rgb / float(shells);
  }
  if (conserving != 0) return reflected * all_bounces(sent, met) / (float(rays) * on_share);
  float at = lattice_shell(shell, shells, farthest_shell, growth);
  return sent * (lattice_attenuation(at, attenuation) * factor[shell] / (float(rays * shells) * on_share));
}

void main() {
  int i = int(global_index());
  if (i >= count) return;
  ReflectiveShadowLight l = rsm_lights[light];
  int shell = on[first_on + i] % shells;
  Ray ray = ray_of(l, on[first_on + i] / shells);
  float scene_m = farthest_surface_m();
  float depth_m = depth_by_ray != 0 ? depth_along(l, ray, scene_m) : scene_m;
  float distance_m = depth_m * lattice_shell(shell, shells, farthest_shell, growth);
  float area_m2 = ray.area_per_squared * (l.light.type == LIGHT_DIRECTIONAL ? 1.0 : distance_m * distance_m);
  virtual_lights[first + i] = VirtualLight(ray.origin + ray.direction * distance_m, area_m2, ray.direction,
                                           VIRTUAL_LIGHT_LATTICE, flux_of(shell), light);
}
