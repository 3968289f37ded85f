#pragma once
// tinygltf under a name of our own: libdraco has another version of it in itself, with the same symbols, and which of
// the two a program gets hangs on the order in which it links. Images are decoded elsewhere.
#define tinygltf volgi_tinygltf
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#include <tiny_gltf.h>
