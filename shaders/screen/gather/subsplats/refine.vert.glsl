#version 450 core
layout(location = 0) in uvec2 subsplat;  // packed; its light in the block, or ALL_LIGHTS
out uvec2 listed;
void main() { listed = subsplat; }
