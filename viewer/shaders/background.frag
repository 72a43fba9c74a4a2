#version 330 core
// Rows of one colour: no visible bands, and they compress well.
uniform float darkness;  // 0: as paper, 1: as a dark room
in vec2 uv;
out vec4 color;

void main() {
  vec3 bottom = mix(vec3(0.955, 0.960, 0.965), vec3(0.170, 0.180, 0.195), darkness);
  vec3 top = mix(vec3(0.785, 0.815, 0.850), vec3(0.085, 0.095, 0.115), darkness);
  color = vec4(mix(bottom, top, smoothstep(0.0, 1.0, uv.y)), 1.0);
}
