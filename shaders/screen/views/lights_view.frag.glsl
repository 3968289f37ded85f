#version 450 core
flat in vec3 color;
flat in float radius_px;
in vec2 on_disk;

uniform int negative;  // rings

layout(location = 0) out vec4 display;

void main() {
  float from_middle = length(on_disk);
  if (from_middle > 1.0 || (negative != 0 && (1.0 - from_middle) * radius_px > max(0.3 * radius_px, 1.5))) discard;
  bool rim = negative == 0 && radius_px > 3.0 && (1.0 - from_middle) * radius_px < 1.0;
  display = vec4(rim ? 0.4 * color : color, 1.0);
}
