#version 450 core
flat in vec3 color;

layout(location = 0) out vec4 display;

void main() { display = vec4(color, 1.0); }
