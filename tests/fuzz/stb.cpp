// stb_image with the fuzzer's instruments, before the system's library.
#define STB_IMAGE_IMPLEMENTATION
#include <stb/stb_image.h>
