#version 450 core
#include "voxel/corner.glsl"
