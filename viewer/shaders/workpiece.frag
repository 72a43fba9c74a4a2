#version 330 core
// The workpiece as made in another draw mode than the mesh: a picture with depth.
uniform sampler2D colors;
uniform sampler2D depths;  // 1 where there is no workpiece
uniform int is_from_top;   // rows of the picture
in vec2 uv;
out vec4 color;

void main() {
  vec2 at = is_from_top != 0 ? vec2(uv.x, 1.0 - uv.y) : uv;
  float depth = texture(depths, at).r;
  if (depth >= 1.0) discard;
  color = vec4(texture(colors, at).rgb, 1.0);
  gl_FragDepth = depth;
}
