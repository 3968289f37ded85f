#version 450 core
// One pass over the flattened buffer that keeps where its fragments are, as stencil bits (Nichols 2010, §4.2.1.1).
#include "screen/gather/subsplats/refined.glsl"

void main() {
  Subsplat s = subsplat_at(picture_size, last_level, ivec2(gl_FragCoord.xy));
  if (s.level < 0 || !is_fragment(s)) discard;
}
