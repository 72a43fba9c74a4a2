#version 330 core
// Lays a picture of twice the size over another one: the mean of 2 x 2 samples, whose colours are
// multiplied by their alpha already.
uniform sampler2D layer;
uniform float opacity;
in vec2 uv;
out vec4 color;

void main() { color = opacity * texture(layer, uv); }
