// Hard shadow of the area light's middle: comparisons in the four nearest texels, interpolated.
float receiver_visibility(VirtualAreaLight light, ShadowReceiver receiver) {
  int resolution = textureSize(shadow_distance, 0).x;
  float receiver_m = length(receiver.position);
  vec2 disk = paraboloid_from_direction(receiver.position / receiver_m);
  float edge_m = texel_angle(disk, resolution) * receiver_m;
  vec2 at = (disk * 0.5 + 0.5) * float(resolution) - 0.5;
  ivec2 first = ivec2(floor(at));
  vec2 t = at - vec2(first);
  float visible = 0.0;
  for (int k = 0; k < 4; ++k) {
    ivec2 corner = ivec2(k & 1, k >> 1);
    ivec2 texel = clamp(first + corner, ivec2(0), ivec2(resolution - 1));
    vec2 w = mix(1.0 - t, t, vec2(corner));
    float distance_m = texelFetch(shadow_distance, ivec3(texel, receiver.layer), 0).r;
    vec2 texel_disk = disk_of_shadow_texel(texel, resolution);
    if (!comparison_hides(receiver, texel_disk, distance_m, receiver_m, edge_m)) visible += w.x * w.y;
  }
  return visible;
}
