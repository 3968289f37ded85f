#version 450 core
// One step from a grid of pixels to one that is twice as fine. A new pixel takes what its neighbours on the coarser grid
// say where they show the same surface and their light varies as a cubic does; the others are listed, to be gathered.
// ALONG: pixels between two of the coarser grid; BETWEEN: between four; neither: the first grid.
#include "screen/base/coarse_pixels.glsl"
#include "screen/base/gbuffer.glsl"
#include "screen/base/smooth_pictures.glsl"
#include "shared/group_sizes.shared.h"
#include "shared/luminance.glsl"
#include "shared/octahedral.glsl"

layout(local_size_x = SQUARE_GROUP, local_size_y = SQUARE_GROUP) in;
layout(binding = SMOOTH_IRRADIANCE_IMAGE, rgba32f) uniform writeonly image2D irradiance[PICTURES];
layout(binding = SMOOTH_STEP_IMAGE, r8ui) uniform writeonly uimage2D gathered_step;
layout(std430, binding = PIXEL_LIST_SLOT) buffer PixelList { WorkListHead head; uint listed[]; };
layout(std430, binding = SMOOTH_MEAN_SLOT) readonly buffer Mean { float mean_irradiance; };
uniform int step_px;      // of the new grid
uniform ivec2 odd;        // places of the new pixels on it, modulo two
uniform float tolerance;  // of the irradiance
uniform float min_cosine;
uniform float off_plane;

struct Surface {
  vec3 position, normal;
};

struct Known {
  vec3 irradiance[PICTURES];
  vec3 normal;
  bool alike;
};

bool on_plane(Surface here, vec4 there) {
  vec3 way = there.xyz - here.position;
  float height = dot(way, here.normal);
  return there.w != 0.0 && height * height <= off_plane * off_plane * dot(way, way);
}

Known known_at(Surface here, ivec2 at) {
  ivec2 inside = clamp(at, ivec2(0), textureSize(position_map, 0) - 1);
  Known k;
  k.normal = octahedral_decode(texelFetch(normal_map, inside, 0).xy);
  k.alike = inside == at && on_plane(here, texelFetch(position_map, inside, 0)) && dot(k.normal, here.normal) >= min_cosine;
  for (int i = 0; i < PICTURES; ++i) k.irradiance[i] = texelFetch(known[i], inside, 0).rgb;
  return k;
}

// Farther away the plane is enough: what is not the same surface shows in how much light varies.
Known known_beyond(Surface here, ivec2 at) {
  ivec2 inside = clamp(at, ivec2(0), textureSize(position_map, 0) - 1);
  Known k;
  k.normal = here.normal;
  k.alike = inside == at && on_plane(here, texelFetch(position_map, inside, 0));
  for (int i = 0; i < PICTURES; ++i) k.irradiance[i] = texelFetch(known[i], inside, 0).rgb;
  return k;
}

struct Guess {
  vec3 irradiance[PICTURES];
  float sum;    // luminance of them all [W m^-2]
  float error;  // estimated
  bool whole;
};

// What neighbours at -3, -1, 1 and 3 steps say of the middle, the outer ones where they show the same surface. The error:
// what curvature adds to a straight line, and what a jump between the inner two, which curvature does not show, leaves
// in third differences.
vec4 line_weights(bool before, bool after) {
  vec4 one = before ? vec4(-0.125, 0.75, 0.375, 0.0) : vec4(0.0, 0.375, 0.75, -0.125);
  vec4 even = before ? vec4(-0.0625, 0.5625, 0.5625, -0.0625) : vec4(0.0, 0.5, 0.5, 0.0);
  return before == after ? even : one;
}

float line_error(vec4 l, bool before, bool after) {
  float jump = abs(l.z - l.y);
  float both = abs(l.x + l.w - l.y - l.z) / 16.0 + abs(l.w - 3.0 * l.z + 3.0 * l.y - l.x) / 8.0;
  float one = abs(before ? l.z - 2.0 * l.y + l.x : l.w - 2.0 * l.z + l.y) / 8.0 + jump / 16.0;
  return before && after ? both : before || after ? one : jump / 4.0;
}

Guess guess_along(Surface here, ivec2 pixel, ivec2 way) {
  Known b = known_at(here, pixel - way), c = known_at(here, pixel + way);
#ifdef INNER_NEIGHBOURS
  Known a = b, d = c;
  bool before = false, after = false;
#else
  Known a = known_beyond(here, pixel - 3 * way), d = known_beyond(here, pixel + 3 * way);
  bool before = a.alike, after = d.alike;
#endif
  vec4 w = line_weights(before, after);
  Guess g;
  g.sum = 0.0;
  g.error = 0.0;
  for (int i = 0; i < PICTURES; ++i) {
    g.irradiance[i] = w.x * a.irradiance[i] + w.y * b.irradiance[i] + w.z * c.irradiance[i] + w.w * d.irradiance[i];
    vec4 l = vec4(luminance(a.irradiance[i]), luminance(b.irradiance[i]), luminance(c.irradiance[i]),
                  luminance(d.irradiance[i]));
    g.error += line_error(l, before, after);
    g.sum += dot(w, l);
  }
  // Irradiance goes with a cosine to what lights: half of the turn is what a normal off its neighbours' is worth.
  g.error += 0.5 * length(normalize(b.normal + c.normal) - here.normal) * g.sum;
  g.whole = b.alike && c.alike;
  return g;
}

#ifdef BETWEEN
// A pixel between four lies on two diagonals; one of them is enough.
Guess guess_of(Surface here, ivec2 pixel) {
  Guess g = guess_along(here, pixel, ivec2(step_px)), h = guess_along(here, pixel, ivec2(step_px, -step_px));
  float to_g = g.whole ? h.whole ? 0.5 : 1.0 : 0.0;
  for (int i = 0; i < PICTURES; ++i) g.irradiance[i] = mix(h.irradiance[i], g.irradiance[i], to_g);
  g.error = mix(h.error, g.error, to_g) + (g.whole && h.whole ? 0.25 * abs(g.sum - h.sum) : 0.0);
  g.sum = mix(h.sum, g.sum, to_g);
  g.whole = g.whole || h.whole;
  return g;
}
#else
Guess guess_of(Surface here, ivec2 pixel) { return guess_along(here, pixel, odd * step_px); }
#endif

void main() {
#if defined(ALONG) || defined(BETWEEN)
  ivec2 pixel = (2 * ivec2(gl_GlobalInvocationID.xy) + odd) * step_px;
#else
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy) * step_px;
#endif
  if (any(greaterThanEqual(pixel, textureSize(position_map, 0)))) return;
  vec4 position = texelFetch(position_map, pixel, 0);
  bool known_here = position.w == 0.0;  // nothing
  Guess guess;
  for (int i = 0; i < PICTURES; ++i) guess.irradiance[i] = vec3(0.0);
#if defined(ALONG) || defined(BETWEEN)
  if (!known_here) {
    guess = guess_of(Surface(position.xyz, octahedral_decode(texelFetch(normal_map, pixel, 0).xy)), pixel);
    known_here = guess.whole && guess.error <= tolerance * max(guess.sum, 0.05 * mean_irradiance);
  }
#endif
  if (known_here) {
    for (int i = 0; i < PICTURES; ++i) imageStore(irradiance[i], pixel, vec4(max(guess.irradiance[i], vec3(0.0)), 1.0));
  } else {
    imageStore(gathered_step, pixel, uvec4(step_px));
    uint slot;
    APPEND_TO_LIST(head, uint(LINEAR_GROUP), slot)
    listed[slot] = pack_pixel(pixel);
  }
}
