// What is no number, by its bits, since compilers take it that there are only numbers.
#ifndef VOLGI_FINITE_GLSL
#define VOLGI_FINITE_GLSL

bool is_nan(float v) { return (floatBitsToUint(v) & 0x7fffffffu) > 0x7f800000u; }
bool is_infinite(float v) { return (floatBitsToUint(v) & 0x7fffffffu) == 0x7f800000u; }

#endif
