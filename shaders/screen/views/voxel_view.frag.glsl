#version 450 core
flat in vec3 color;
in vec2 on_face;

layout(location = 0) out vec4 display;

const float RIM = 0.14;  // of the way from a face's edge to its middle, a pixel at least
const float RIM_BRIGHTNESS = 0.55;

void main() {
  vec2 pixel = fwidth(on_face);
  vec2 begin = 1.0 - max(vec2(RIM), pixel);
  vec2 rims = smoothstep(begin - 0.5 * pixel, begin + 0.5 * pixel, abs(on_face));
  rims *= clamp(2.5 - 8.0 * pixel, 0.0, 1.0);  // none across where a face is a few pixels wide
  display = vec4(color * mix(1.0, RIM_BRIGHTNESS, max(rims.x, rims.y)), 1.0);
}
