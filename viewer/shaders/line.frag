#version 330 core
uniform float half_px;
uniform int is_smooth;
noperspective in vec2 local_px;
flat in float length_px;
flat in vec4 line_rgba;
out vec4 color;

void main() {
  float off = length(vec2(local_px.x - clamp(local_px.x, 0.0, length_px), local_px.y));
  float cover = is_smooth != 0 ? clamp(half_px + 0.5 - off, 0.0, 1.0) : step(off, half_px);
  if (cover == 0.0) discard;
  color = vec4(line_rgba.rgb, line_rgba.a * cover);
}
