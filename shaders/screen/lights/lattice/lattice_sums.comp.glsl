#version 450 core
// What a light's shadow map says about the scene: FARTHEST: how deep it is; else how much of the light's flux meets
// surfaces between each shell and the next. In cones of spots, no wider.
#include "shared/reflective_shadow_map.glsl"
#include "screen/lights/lattice/lattice_sums.glsl"

layout(local_size_x = LATTICE_GROUP) in;
uniform int light;
uniform int shells;
uniform float farthest_shell;
uniform float growth;

// Power that the light sends through a texel, without its range [W], and a unit vector that way.
vec3 sent_through(ReflectiveShadowLight l, ReflectiveShadowLayer view, vec2 uv, out vec3 direction) {
  direction = view.forward;
  vec3 radiant = l.light.intensity;
  if (l.light.type != LIGHT_DIRECTIONAL)
    direction = normalize(view.forward + view.right * (uv.x * view.extent_x) + view.up * (uv.y * view.extent_y));
  if (l.light.type == LIGHT_SPOT) radiant *= spot_falloff(l.light, direction);
  return radiant * rsm_texel_measure(view, l.resolution, uv.x, uv.y);
}

struct Seen {
  bool counts;  // the texel is the light's, and of this layer alone
  vec3 sent;    // [W]
  float distance_m;  // of the surface, or 0: none
  vec3 albedo;
};

Seen look(ReflectiveShadowLight l, int texel_index) {
  int each = l.resolution * l.resolution;
  int layer = texel_index / each;
  ivec2 texel = ivec2(texel_index % l.resolution, texel_index % each / l.resolution);
  Seen seen = Seen(false, vec3(0.0), 0.0, vec3(0.0));
  if (!rsm_texel_counts(l.layer_count, l.resolution, texel.x, texel.y)) return seen;
  if (l.light.type == LIGHT_DIRECTIONAL && !rsm_texel_counts(6, l.resolution, texel.x, texel.y)) return seen;
  ReflectiveShadowLayer view = rsm_layers[l.first_layer + layer];
  vec2 uv = (vec2(texel) + 0.5) * (2.0 / float(l.resolution)) - 1.0;
  vec3 direction;
  seen.sent = sent_through(l, view, uv, direction);
  seen.counts = any(greaterThan(seen.sent, vec3(0.0)));
  float depth = texelFetch(rsm_depth, ivec3(texel, layer), 0).r;
  if (!seen.counts || depth <= 0.0) return seen;
  float z = rsm_z_from_depth(view, depth);
  seen.distance_m = view.directional != 0 ? z : z / max(dot(direction, view.forward), 1e-30);
  seen.albedo = texelFetch(rsm_albedo, ivec3(texel, layer), 0).rgb;
  return seen;
}

#ifdef FARTHEST
shared float of_thread[LATTICE_GROUP];
#else
// One row a quantity, added thread by thread.
#define ROWS (LATTICE_MAX_SHELLS + 2)
shared vec3 of_thread[ROWS][LATTICE_GROUP];
#endif

void main() {
  ReflectiveShadowLight l = rsm_lights[light];
  int texels = l.layer_count * l.resolution * l.resolution;
  int lane = int(gl_LocalInvocationIndex);
  int group = int(gl_WorkGroupID.x);
#ifdef FARTHEST
  float farthest = 0.0;
  for (int i = group * LATTICE_GROUP + lane; i < texels; i += LATTICE_GROUPS * LATTICE_GROUP)
    farthest = max(farthest, look(l, i).distance_m);
  of_thread[lane] = farthest;
  barrier();
  if (lane != 0) return;
  for (int t = 1; t < LATTICE_GROUP; ++t) farthest = max(farthest, of_thread[t]);
  sums[group].farthest_m = farthest;
#else
  float depth_m = farthest_surface_m();
  vec3 row[ROWS];
  for (int r = 0; r < ROWS; ++r) row[r] = vec3(0.0);
  for (int i = group * LATTICE_GROUP + lane; i < texels; i += LATTICE_GROUPS * LATTICE_GROUP) {
    Seen seen = look(l, i);
    if (!seen.counts) continue;
    row[LATTICE_MAX_SHELLS] += seen.sent;
    if (seen.distance_m <= 0.0) continue;
    vec3 met = seen.sent * (l.light.type == LIGHT_DIRECTIONAL ? 1.0 : range_window(l.light, seen.distance_m));
    row[LATTICE_MAX_SHELLS + 1] += met;
    // The last shell that lies before the surface; the first, where all lie behind it.
    for (int shell = shells - 1; shell >= 0; --shell) {
      bool before = seen.distance_m >= depth_m * lattice_shell(shell, shells, farthest_shell, growth);
      if (!before && shell > 0) continue;
      row[shell] += met * seen.albedo;
      break;
    }
  }
  for (int r = 0; r < ROWS; ++r) of_thread[r][lane] = row[r];
  barrier();
  if (lane >= ROWS) return;
  vec3 sum = vec3(0.0);
  for (int t = 0; t < LATTICE_GROUP; ++t) sum += of_thread[lane][t];
  if (lane < LATTICE_MAX_SHELLS) sums[group].reflected[lane] = vec4(sum, 0.0);
  else if (lane == LATTICE_MAX_SHELLS) sums[group].sent = vec4(sum, 0.0);
  else sums[group].met = vec4(sum, 0.0);
#endif
}
