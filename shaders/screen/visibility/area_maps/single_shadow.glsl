// Hard shadow: comparisons in the four nearest texels, interpolated. The map has `resolution` texels on a side, from
// `corner` of the receiver's layer on.
float map_visibility(ShadowReceiver receiver, int resolution, ivec2 corner) {
  float receiver_m = length(receiver.position);
  vec2 disk = paraboloid_from_direction(receiver.position / receiver_m);
  float edge_m = texel_angle(disk, resolution) * receiver_m;
  vec2 at = (disk * 0.5 + 0.5) * float(resolution) - 0.5;
  vec2 first = clamp(floor(at), vec2(0.0), vec2(float(resolution - 2)));
  vec2 t = clamp(at - first, vec2(0.0), vec2(1.0));
  // Looked up in the middle of the four, where rounding cannot choose others; they come anticlockwise from (0, 1).
  vec4 distances_m = textureGather(
      shadow_distance,
      vec3((vec2(corner) + first + 1.0) / vec2(textureSize(shadow_distance, 0).xy), float(receiver.layer)));
  const vec2 CORNERS[4] = vec2[](vec2(0.0, 1.0), vec2(1.0, 1.0), vec2(1.0, 0.0), vec2(0.0, 0.0));
  float visible = 0.0;
  for (int k = 0; k < 4; ++k) {
    vec2 texel_disk = (first + CORNERS[k] + 0.5) * (2.0 / float(resolution)) - 1.0;
    vec2 w = mix(1.0 - t, t, CORNERS[k]);
    bool hides = comparison_hides(receiver, texel_disk, distances_m[k], receiver_m, edge_m);
    visible += hides ? 0.0 : w.x * w.y;
  }
  return visible;
}

float receiver_visibility(VirtualAreaLight light, ShadowReceiver receiver) {
  return map_visibility(receiver, textureSize(shadow_distance, 0).x, ivec2(0));
}
