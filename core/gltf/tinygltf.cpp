#define TINYGLTF_IMPLEMENTATION
#include "core/gltf/tinygltf_internal.h"
