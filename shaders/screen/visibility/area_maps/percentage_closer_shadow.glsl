// Soft shadow by percentage-closer filtering over the penumbra. The filter is the light itself, seen from the receiver
// through the mean distance of its blockers: points of the light's square, joined with the receiver, and followed to
// that distance. Seen from the light's middle it is as wide as section 4.2 of Dong et al. 2009 has it,
// (d - z_avg) Delta / (z_avg d), and has the square's shape and slope too.
#define SEARCH_TAPS 8
#define SHADOW_TAPS 16

// Points of the plastic number's lattice (Roberts 2018, "R2"), which fill a square evenly in any number; -1/2 to 1/2.
vec2 light_point(int i) { return fract(vec2(0.7548776662, 0.5698402910) * float(i + 1)) - 0.5; }

struct Filter {
  int resolution;
  float receiver_m;
  float edge_m;  // of a texel at the receiver
};

// Looks where the way from the receiver to `on_light` passes at `depth` of the receiver's distance.
// @return whether the map hides it, and how far the blocker is.
bool tap_hides(ShadowReceiver receiver, Filter f, vec2 on_light, float depth, out float distance_m) {
  vec3 at = receiver.position * depth + vec3(on_light * (1.0 - depth), 0.0);
  vec2 disk = paraboloid_from_direction(normalize(at));
  ivec2 texel = clamp(ivec2((disk * 0.5 + 0.5) * float(f.resolution)), ivec2(0), ivec2(f.resolution - 1));
  distance_m = texelFetch(shadow_distance, ivec3(texel, receiver.layer), 0).r;
  return comparison_hides(receiver, disk_of_shadow_texel(texel, f.resolution), distance_m, f.receiver_m, f.edge_m);
}

// Points of the light below the receiver's horizon do not count: no light comes from there.
bool tap_counts(ShadowReceiver receiver, vec2 on_light) {
  return dot(vec3(on_light, 0.0) - receiver.position, receiver.normal) > 0.0;
}

// The light's size or, where a texel's edge is wider than the filter, what makes the filter that wide.
float filter_size(float size_m, Filter f, float depth) {
  return max(size_m, f.edge_m * depth / max(1.0 - depth, 1e-6));
}

float receiver_visibility(VirtualAreaLight light, ShadowReceiver receiver) {
  Filter f;
  f.resolution = textureSize(shadow_distance, 0).x;
  f.receiver_m = length(receiver.position);
  vec2 disk = paraboloid_from_direction(receiver.position / f.receiver_m);
  f.edge_m = texel_angle(disk, f.resolution) * f.receiver_m;

  // The first filter is as wide as the light is seen from the receiver: half-way.
  float blockers = 0.0;
  float sum_m = 0.0;
  for (int i = 0; i < SEARCH_TAPS; ++i) {
    float distance_m;
    if (tap_hides(receiver, f, filter_size(light.size_m, f, 0.5) * light_point(i), 0.5, distance_m)) {
      blockers += 1.0;
      sum_m += distance_m;
    }
  }
  if (blockers == 0.0) return 1.0;
  float depth = min(sum_m / (blockers * f.receiver_m), 1.0);

  float size_m = filter_size(light.size_m, f, depth);
  float counted = 0.0;
  float visible = 0.0;
  for (int i = 0; i < SHADOW_TAPS; ++i) {
    vec2 on_light = size_m * light_point(i);
    if (!tap_counts(receiver, on_light)) continue;
    counted += 1.0;
    float distance_m;
    if (!tap_hides(receiver, f, on_light, depth, distance_m)) visible += 1.0;
  }
  return counted > 0.0 ? visible / counted : 1.0;
}
