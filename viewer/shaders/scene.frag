#version 330 core
// One pass, cheap enough for software renderers: sky, two lamps and a soft gleam.
uniform vec4 rgba;
uniform vec3 up_view;  // +Z of the workpiece
in vec3 normal_view;
out vec4 color;

const vec3 kKey = vec3(-0.6210, 0.3506, 0.7011);  // directions to the lamps, view space
const vec3 kFill = vec3(0.8136, 0.2034, 0.5447);
const vec3 kHalfway = vec3(-0.3367, 0.1901, 0.9222);  // between the key lamp and the eye

void main() {
  vec3 n = normal_view * inversesqrt(max(dot(normal_view, normal_view), 1e-6));
  if (!gl_FrontFacing) n = -n;
  float sky = 0.36 + 0.14 * dot(n, up_view);
  float light = sky + 0.50 * max(0.0, dot(n, kKey)) + 0.22 * max(0.0, dot(n, kFill));
  float gleam = max(0.0, dot(n, kHalfway));
  gleam *= gleam;
  gleam *= gleam;
  gleam *= gleam;
  color = vec4(rgba.rgb * light + 0.14 * gleam * gleam, rgba.a);
}
