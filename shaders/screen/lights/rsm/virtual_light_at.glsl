// Where a light's ray meets what its reflective shadow map shows: between the texels' centres, so that virtual lights
// move as smoothly as the light does.
#include "screen/lights/rsm/slots.shared.h"
#include "shared/reflective_shadow_map.glsl"
#include "shared/virtual_light.shared.h"

layout(std430, binding = SAMPLED_LIGHTS_SLOT) buffer Lights { VirtualLight virtual_lights[]; };
layout(std430, binding = LIGHT_SAMPLES_SLOT) readonly buffer Samples { vec4 samples[]; };
uniform int light;
uniform int count;         // virtual lights of this light
uniform int first;         // where they begin among the virtual lights of all
uniform int first_sample;  // where its samples begin among those of all

#define NEVER 3.0e38

struct Ray {  // position = origin + z * step, z along the layer's forward axis
  vec3 origin;
  vec3 step;
};

struct Facet {  // the piece of plane that a texel shows
  vec3 middle;
  vec3 normal;
  float z;
};

struct Meeting {
  vec3 position;
  vec3 normal;
  ivec2 texel;  // that shows it
};

Ray ray_at(ReflectiveShadowLayer view, vec2 uv) {
  vec3 across = view.right * (uv.x * view.extent_x) + view.up * (uv.y * view.extent_y);
  if (view.directional != 0) return Ray(view.origin + across, view.forward);
  return Ray(view.origin, view.forward + across);
}

vec2 uv_of_middle(int resolution, ivec2 texel) { return (vec2(texel) + 0.5) * (2.0 / float(resolution)) - 1.0; }

bool facet_in(ReflectiveShadowLayer view, int resolution, ivec3 texel, out Facet facet) {
  float depth = texelFetch(rsm_depth, texel, 0).r;
  if (depth <= 0.0) return false;
  facet.z = rsm_z_from_depth(view, depth);
  facet.middle = rsm_position_from_uvz(view, vec3(uv_of_middle(resolution, texel.xy), facet.z));
  facet.normal = octahedral_decode(texelFetch(rsm_normal, texel, 0).rg);
  return true;
}

// Where the ray crosses the facet's plane.
float z_on(Facet facet, Ray ray) {
  float slope = dot(ray.step, facet.normal);
  float z = dot(facet.middle - ray.origin, facet.normal) / (slope < 0.0 ? slope : -1e-30);
  return slope < 0.0 && z > 0.0 && z < NEVER ? z : NEVER;
}

// The ray's own crossing with its texel's plane. Two of the 2 x 2 texels around may form a corner that opens to the
// light; then the nearer plane counts, as far as depths around allow. A plane seen so obliquely that the crossing lies
// more than two texels away is trusted only where all four texels lie on it.
bool meet(ReflectiveShadowLayer view, int resolution, int layer, vec2 uv, ivec2 texel, out Meeting meeting) {
  Facet own;
  if (!facet_in(view, resolution, ivec3(texel, layer), own)) return false;
  Ray ray = ray_at(view, uv);
  vec2 beside = uv - uv_of_middle(resolution, texel);
  ivec2 towards = ivec2(beside.x < 0.0 ? -1 : 1, beside.y < 0.0 ? -1 : 1);
  float size = rsm_texel_size_m(view, resolution, own.z);
  float z = z_on(own, ray);
  float own_z = z;
  bool flat_around = true;
  meeting = Meeting(own.middle, own.normal, texel);
  for (int k = 1; k < 4; ++k) {
    ivec2 next = clamp(texel + towards * ivec2(k & 1, k >> 1), ivec2(0), ivec2(resolution - 1));
    Facet other;
    if (!facet_in(view, resolution, ivec3(next, layer), other)) {
      flat_around = false;
      continue;
    }
    // What the numbers err, as in rsm_occluder.
    vec3 d = other.middle - own.middle;
    float range = view.directional != 0 ? view.depth_scale_m : own.z;
    float error = size / 256.0 + (range + length(own.middle)) / 1048576.0 + length(d) * OCTAHEDRAL_ERROR_RAD;
    float height = dot(d, own.normal);
    if (abs(height) > error) flat_around = false;
    if (height <= error || dot(d, other.normal) >= -error) continue;
    float other_z = z_on(other, ray);
    if (other_z < z && other_z > min(own.z, other.z) - 2.0 * size) {
      z = other_z;
      meeting.normal = other.normal;
      meeting.texel = next;
    }
  }
  vec3 crossing = ray.origin + z * ray.step;
  bool own_plane = z == own_z;
  if (!own_plane || (z < NEVER && (flat_around || distance(crossing, own.middle) <= 2.0 * size))) {
    meeting.position = crossing;
  }
  return true;
}

// Squared distance to the light over the cosine at the surface: turns a solid angle into area; of a sun, the inverse
// cosine. docs/conventions.md#virtual-lights: cosines below 0.05 would make lights that stand for surface far away.
float area_of_measure(ReflectiveShadowLayer view, Meeting meeting) {
  vec3 from_light = view.directional != 0 ? view.forward : meeting.position - view.origin;
  float squared = dot(from_light, from_light);
  float cosine = -dot(from_light, meeting.normal) / max(sqrt(squared), 1e-30);
  return squared / max(cosine, 0.05);
}

// Stands for a ray that met nothing.
VirtualLight no_light(ReflectiveShadowLayer view, vec2 uv) {
  Ray ray = ray_at(view, uv);
  return VirtualLight(ray.origin, 0.0, -normalize(ray.step), VIRTUAL_LIGHT_REFLECTED, vec3(0.0), light);
}
