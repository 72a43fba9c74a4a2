#version 330 core
// Sets alpha where the stencil lets it.
out vec4 color;

void main() { color = vec4(1.0); }
