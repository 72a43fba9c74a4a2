#version 330 core
uniform bool is_round;
in vec4 marker_rgba;
out vec4 color;

void main() {
  color = marker_rgba;
  if (is_round) {
    float from_middle = length(gl_PointCoord * 2.0 - 1.0);
    if (from_middle > 1.0) discard;
    if (from_middle > 0.7) color.rgb *= 0.45;  // a rim, so that it is seen on any ground
  }
}
