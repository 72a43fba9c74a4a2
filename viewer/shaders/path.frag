#version 330 core
flat in vec4 line_rgba;
out vec4 color;

void main() {
  if (line_rgba.a == 0.0) discard;  // a kind that is not shown
  color = line_rgba;
}
