// The step of convolution shadow maps as a Fourier series: whether what is at depth z leaves light for a receiver at
// depth d, x = z - d. Annen et al. 2007, "Convolution Shadow Maps", eq. 8, with 4 terms:
//   s(x) = 1/2 + 2/pi sum over k = 1..4 of sin((2k - 1) pi x) / (2k - 1),   period 2, odd about 1/2.
// Between the steps at x = 0 and 1 its extremes are x = j/8. The deepest ripple is s(1/4) = 1 - LEAK, so that in full
// shadow at most LEAK shows. Stretched to (s - LEAK) / (1 - 2 LEAK) and clamped, shadow is 0 and light 1 wherever
// STEP <= |x| <= 1 - STEP, where STEP is the first x with s = 1 - LEAK. Hence
//   - receivers are moved towards the light by STEP, which lights those that nothing hides;
//   - depths run from 0 to 1 - 2 STEP, so that no |x| exceeds 1 - STEP.
#ifndef VOLGI_CONVOLUTION_BASIS_GLSL
#define VOLGI_CONVOLUTION_BASIS_GLSL
#include "shared/constants.glsl"

const float STEP_LEAK = 0.054129062;
const float STEP_WIDTH = 0.064223325;
const float STEP_RANGE = 1.0 - 2.0 * STEP_WIDTH;
// What 8 bits may err by in s: 2/pi sum 1 / (2k - 1), times |sin| + |cos| <= sqrt(2), times 1/255 (half a step of
// values from -1 to 1).
const float STEP_ROUNDING = 1.0671 * 1.4142 / 255.0;
const vec4 STEP_FREQUENCY = vec4(1.0, 3.0, 5.0, 7.0) * PI;

// Depth in the series' units: distance over the farthest that the layer sees; where there is nothing, the end. So one
// far thing takes resolution from all others: from where a blocker is, the step has risen only 2 STEP farther on, 15 %
// of the farthest distance. (Scales that favour the near side, t / (t + s) and linear up to once or twice the harmonic
// mean, left up to twice as much light in the shadows of cornell and atrium.)
float step_depth(float distance_m, float farthest_m) { return STEP_RANGE * min(distance_m / farthest_m, 1.0); }

#endif
