#version 450 core
// What a pixel's mirror of facets reflects: rays through its lobe to the sides of the volume, or to the sky, and lights
// on emissive surfaces, each seen as far as blocked faces let it. The two ways to find emission are weighed by how
// likely each finds it (Veach and Guibas 1995, the balance heuristic): broad lobes find small lights by the lights,
// narrow ones large lights by rays. Every pixel of a block takes one subset of both.
// Set by the program: PHONG, where mirrors are Phong lobes
#include "screen/base/gbuffer.glsl"
#include "screen/base/halton_pixel.glsl"
#include "screen/base/lobe.glsl"
#include "screen/base/sky_picture.glsl"
#include "screen/bounces/glossy/slots.shared.h"
#include "shared/disk_to_point.shared.h"
#include "shared/group_sizes.shared.h"
#include "shared/luminance.glsl"
#include "shared/octahedral.glsl"
#include "shared/virtual_light.shared.h"
#include "voxel/face_walk.glsl"

layout(local_size_x = SQUARE_GROUP, local_size_y = SQUARE_GROUP) in;
layout(binding = GBUFFER_DIFFUSE_UNIT) uniform sampler2D diffuse_map;
layout(binding = GBUFFER_MIRROR_UNIT) uniform sampler2D mirror_map;
layout(binding = GLOSSY_SKY_UNIT) uniform sampler2D sky;
layout(std430, binding = GLOSSY_RADIOSITY_SLOT) readonly buffer Radiosity { vec4 radiosity[]; };
layout(std430, binding = GLOSSY_LIGHTS_SLOT) readonly buffer AreaLights { VirtualLight area_lights[]; };
layout(std430, binding = GLOSSY_LIGHT_SIDES_SLOT) readonly buffer LightSides { float emitted_there[]; };
layout(std430, binding = GLOSSY_COUNTS_SLOT) buffer Counts { uint glossy_pixels, clamped_pixels; };
layout(binding = GLOSSY_DIRECT_IMAGE, rgba32f) uniform writeonly image2D direct;
layout(binding = GLOSSY_INDIRECT_IMAGE, rgba32f) uniform writeonly image2D indirect;
uniform vec4 viewer;  // position and 1, or the direction towards an orthographic camera and 0
uniform int rays;
uniform int interleave;  // pixels of a block of n x n share rays and lights
uniform int first_point;  // of the Halton sequence
uniform float least_roughness;
uniform int light_count;
uniform float lights_per_watt;
uniform float lights_per_m2;
uniform int has_sky;
uniform float sky_rotation_rad;

#define BODY_CELLS 1.2  // before a light

int subsets() { return interleave * interleave; }

struct Receiver {
  vec3 position, geometric;
  Lobe lobe;
};

vec3 sky_radiance(vec3 d, float density) {
  if (has_sky == 0) return vec3(0.0);
  // As large a part of it as a ray stands for (Colbert and Krivanek 2007, "GPU-Based Importance Sampling").
  vec2 texels = vec2(textureSize(sky, 0));
  float lod = 0.5 * log2(texels.x * texels.y / (4.0 * PI * max(density, 1e-6)));
  return textureLod(sky, sky_uv(d, sky_rotation_rad), max(lod, 0.0)).rgb;
}

struct Seen {
  vec3 direct, indirect;
};

// @param density  of all rays of a block about d [1/sr].
Seen look(Receiver s, vec3 d, float density) {
  Seen seen = Seen(vec3(0.0), vec3(0.0));
  FaceWalk walk = begin_walk(cell_from_world(grid, s.position), s.geometric, d);
  float left = 1.0;
  while (left > 0.02) {
    uint id = next_side(walk, 1e9);
    if (id == NO_SIDE) {
      seen.direct += left * sky_radiance(d, density);
      break;
    }
    float stopped = left * sides[id].coverage;
    vec3 emitted = sides[id].radiosity;
    float cosine = max(-dot(d, sides[id].normal), 1e-3);
    float way_m = max(walk.way, 0.5) * grid.cell_size_m;
    float of_lights = (luminance(emitted) * lights_per_watt + lights_per_m2) * way_m * way_m / cosine;
    seen.direct += emitted * (stopped / PI * density / (density + of_lights));
    seen.indirect += radiosity[id].rgb * (stopped / PI);
    left -= stopped;
  }
  return seen;
}

Seen by_rays(Receiver s, int subset) {
  Seen sum = Seen(vec3(0.0), vec3(0.0));
  mat3 frame = frame_around(s.lobe.normal);
  for (int k = 0; k < rays; ++k) {
    uint i = uint(first_point + k * subsets() + subset);
    vec3 l = lobe_direction(s.lobe, frame, vec2(float(bitfieldReverse(i)) / 4294967296.0, radical_inverse_3(i)));
    float cosine = dot(s.lobe.normal, l);
    if (cosine <= 0.0 || dot(s.geometric, l) <= 0.0) continue;
    vec3 weight = lobe_weight(s.lobe, l, cosine) / float(rays);
    Seen seen = look(s, l, float(rays * subsets()) * lobe_density(s.lobe, l));
    sum.direct += weight * seen.direct;
    sum.indirect += weight * seen.indirect;
  }
  return sum;
}

// Not asking what hides it.
vec3 of_light(Receiver s, VirtualLight light, float there) {
  vec3 w = light.position - s.position;
  float squared = dot(w, w), height = -dot(w, light.normal), along = dot(w, s.lobe.normal);
  if (min(height, min(along, dot(w, s.geometric))) <= 0.0) return vec3(0.0);
  float nearer = inversesqrt(squared);
  vec3 l = w * nearer;
  vec3 reflectance = lobe_reflectance(s.lobe, l, max(along * nearer, 1e-4));
  float form = disk_to_point(height, along, -dot(light.normal, s.lobe.normal), squared, light.area_m2);
  float of_rays = float(rays * subsets()) * lobe_density(s.lobe, l);
  // As rays count it, which know the light's surface by its side.
  float of_lights = (there * lights_per_watt + lights_per_m2) * squared / max(height * nearer, 1e-3);
  return light.flux * reflectance * (there > 0.0 ? form * of_lights / (of_rays + of_lights) : form);
}

float seen_share(Receiver s, vec3 light) {
  vec3 point = cell_from_world(grid, s.position), w = cell_from_world(grid, light) - point;
  float cells = length(w);
  FaceWalk walk = begin_walk(point, s.geometric, w / cells);
  return open_share(walk, cells - dot(walk.start - point, w / cells) - BODY_CELLS);
}

// Lights that together are at most a thirty-second of all are seen as far as the others.
vec3 by_lights(Receiver s, int subset) {
  float all = 0.0, looked_at = 0.0, seen = 0.0;
  for (int k = subset; k < light_count; k += subsets()) all += luminance(of_light(s, area_lights[k], emitted_there[k]));
  float least = all * float(subsets()) / (32.0 * float(light_count));
  vec3 sum = vec3(0.0), small = vec3(0.0);
  for (int k = subset; k < light_count && all > 0.0; k += subsets()) {
    vec3 radiance = of_light(s, area_lights[k], emitted_there[k]);
    float l = luminance(radiance);
    if (l <= least) {
      small += radiance;
      continue;
    }
    float share = seen_share(s, area_lights[k].position);
    sum += share * radiance;
    looked_at += l;
    seen += share * l;
  }
  return float(subsets()) * (sum + small * (looked_at > 0.0 ? seen / looked_at : 1.0));
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, textureSize(position_map, 0)))) return;
  vec4 position = texelFetch(position_map, pixel, 0);
  vec4 d = vec4(0.0), i = vec4(0.0);
  float apart = 1.0 - texelFetch(albedo_map, pixel, 0).a;
  if (position.w != 0.0 && apart > 0.0) {
    vec4 normals = texelFetch(normal_map, pixel, 0), mirror = texelFetch(mirror_map, pixel, 0);
    float roughness = texelFetch(diffuse_map, pixel, 0).a;
    Receiver s;
    s.position = position.xyz;
    s.geometric = octahedral_decode(normals.zw);
    s.lobe = lobe_of(octahedral_decode(normals.xy), normalize(viewer.xyz - position.xyz * viewer.w), mirror,
                     max(roughness, least_roughness));
    ivec2 place = pixel % interleave;
    int subset = place.x + interleave * place.y;
    Seen seen = by_rays(s, subset);
    d = vec4(apart * (seen.direct + by_lights(s, subset)), 1.0);
    i = vec4(apart * seen.indirect, 1.0);
    atomicAdd(glossy_pixels, 1u);
    if (roughness < least_roughness - 1e-4) atomicAdd(clamped_pixels, 1u);
  }
  imageStore(direct, pixel, d);
  imageStore(indirect, pixel, i);
}
