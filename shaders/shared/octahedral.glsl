// Unit vectors in two numbers of [-1, 1]. Cigolle et al. 2014, "A Survey of Efficient Representations for Independent
// Unit Vectors", without their search for the best rounding: 16 bits a number err by less than 2^-14 rad.
#ifndef VOLGI_OCTAHEDRAL_GLSL
#define VOLGI_OCTAHEDRAL_GLSL

#define OCTAHEDRAL_ERROR_RAD (1.0 / 16384.0)

vec2 octahedral_fold(vec2 v) { return (1.0 - abs(v.yx)) * vec2(v.x >= 0.0 ? 1.0 : -1.0, v.y >= 0.0 ? 1.0 : -1.0); }

vec2 octahedral_encode(vec3 unit) {
  vec2 v = unit.xy / max(abs(unit.x) + abs(unit.y) + abs(unit.z), 1e-30);
  return unit.z >= 0.0 ? v : octahedral_fold(v);
}

vec3 octahedral_decode(vec2 v) {
  float z = 1.0 - abs(v.x) - abs(v.y);
  return normalize(vec3(z >= 0.0 ? v : octahedral_fold(v), z));
}

#endif
