// A cell's lobes, one a colour, of the SH schemes: ORDER 1 one vec4 each; ORDER 2 nine numbers, the last ones of the three
// colours together. In textures the parts are stacked in z: three low, three mid, one high. Set by the program: ORDER.
#include "shared/sh.shared.h"

#if ORDER == 1
#define Lobe vec4
const int LOBE_TEXELS = 3;

Lobe dark_lobe() { return vec4(0.0); }
void add_lobe(inout Lobe to, float factor, Lobe lobe) { to += factor * lobe; }
void add_lobe(inout Lobe to, Lobe lobe) { to += lobe; }
float lobe_power(Lobe lobe) { return lobe.x; }
#else
#define Lobe Lobe9
const int LOBE_TEXELS = 7;

Lobe dark_lobe() { return Lobe(vec4(0.0), vec4(0.0), 0.0); }
void add_lobe(inout Lobe to, float factor, Lobe lobe) {
  to.low += factor * lobe.low;
  to.mid += factor * lobe.mid;
  to.high += factor * lobe.high;
}
void add_lobe(inout Lobe to, Lobe lobe) { add_lobe(to, 1.0, lobe); }
float lobe_power(Lobe lobe) { return lobe.low.x; }
#endif

struct Lobes {
  Lobe red, green, blue;
};

Lobes dark_lobes() { return Lobes(dark_lobe(), dark_lobe(), dark_lobe()); }
vec3 lobe_powers(Lobes l) { return vec3(lobe_power(l.red), lobe_power(l.green), lobe_power(l.blue)); }
void add_lobes(inout Lobes to, vec3 factor, Lobe lobe) {
  add_lobe(to.red, factor.r, lobe);
  add_lobe(to.green, factor.g, lobe);
  add_lobe(to.blue, factor.b, lobe);
}

#if ORDER == 1
Lobes load_lobes(sampler3D from, ivec3 c, int depth) {
  return Lobes(texelFetch(from, c, 0), texelFetch(from, c + ivec3(0, 0, depth), 0),
               texelFetch(from, c + ivec3(0, 0, 2 * depth), 0));
}
#define STORE_LOBES(image, c, depth, lobes)                      \
  {                                                              \
    imageStore(image, c, lobes.red);                             \
    imageStore(image, c + ivec3(0, 0, depth), lobes.green);      \
    imageStore(image, c + ivec3(0, 0, 2 * depth), lobes.blue);   \
  }
#else
Lobes load_lobes(sampler3D from, ivec3 c, int depth) {
  ivec3 step = ivec3(0, 0, depth);
  vec3 high = texelFetch(from, c + 6 * step, 0).rgb;
  return Lobes(Lobe(texelFetch(from, c, 0), texelFetch(from, c + 3 * step, 0), high.r),
               Lobe(texelFetch(from, c + step, 0), texelFetch(from, c + 4 * step, 0), high.g),
               Lobe(texelFetch(from, c + 2 * step, 0), texelFetch(from, c + 5 * step, 0), high.b));
}
#define STORE_LOBES(image, c, depth, lobes)                                                              \
  {                                                                                                      \
    imageStore(image, c, lobes.red.low);                                                                 \
    imageStore(image, c + ivec3(0, 0, depth), lobes.green.low);                                          \
    imageStore(image, c + ivec3(0, 0, 2 * depth), lobes.blue.low);                                       \
    imageStore(image, c + ivec3(0, 0, 3 * depth), lobes.red.mid);                                        \
    imageStore(image, c + ivec3(0, 0, 4 * depth), lobes.green.mid);                                      \
    imageStore(image, c + ivec3(0, 0, 5 * depth), lobes.blue.mid);                                       \
    imageStore(image, c + ivec3(0, 0, 6 * depth), vec4(lobes.red.high, lobes.green.high, lobes.blue.high, 0.0)); \
  }
#endif
