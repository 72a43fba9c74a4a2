#version 330 core
// Rows of one colour: no visible bands, and they compress well.
in vec2 uv;
out vec4 color;

void main() {
  vec3 bottom = vec3(0.955, 0.960, 0.965), top = vec3(0.785, 0.815, 0.850);
  color = vec4(mix(bottom, top, smoothstep(0.0, 1.0, uv.y)), 1.0);
}
