#version 330 core
// One pass, cheap enough for software renderers: sky, two lamps and a soft gleam.
uniform vec4 rgba;
uniform vec3 up_view;  // +Z of the workpiece
in vec3 normal_view;
out vec4 color;

#ifdef BESIDE_GLASS
// Drawn over a transparent workpiece in two turns: what lies behind its surface, what lies before.
uniform sampler2D glass_depths;
uniform int is_behind;
#endif

#ifdef COLORED
uniform int source;
uniform vec3 stops[5];  // heights: evenly from 0 to 1; deviations: -2, -1 (the tolerance), 0, 1, 2
flat in vec3 move_rgb;
in float measure;

vec3 height_rgb() {
  float at = clamp(measure, 0.0, 1.0) * 4.0;
  int first = min(int(at), 3);
  return mix(stops[first], stops[first + 1], at - float(first));
}

vec3 deviation_rgb() {
  float beyond = clamp(abs(measure) - 1.0, 0.0, 1.0);
  if (beyond == 0.0) return stops[2];
  return measure < 0.0 ? mix(stops[1], stops[0], beyond) : mix(stops[3], stops[4], beyond);
}
#endif

const vec3 kKey = vec3(-0.6210, 0.3506, 0.7011);  // directions to the lamps, view space
const vec3 kFill = vec3(0.8136, 0.2034, 0.5447);
const vec3 kHalfway = vec3(-0.3367, 0.1901, 0.9222);  // between the key lamp and the eye

void main() {
#ifdef BESIDE_GLASS
  bool lies_behind = gl_FragCoord.z >= texelFetch(glass_depths, ivec2(gl_FragCoord.xy), 0).r;
  if (lies_behind != (is_behind == 1)) discard;
#endif
  vec3 base = rgba.rgb;
#ifdef COLORED
  base = source == 1 ? move_rgb : source == 2 ? deviation_rgb() : height_rgb();
#endif
  vec3 n = normal_view * inversesqrt(max(dot(normal_view, normal_view), 1e-6));
  if (!gl_FrontFacing) n = -n;
  float sky = 0.36 + 0.14 * dot(n, up_view);
  float light = sky + 0.50 * max(0.0, dot(n, kKey)) + 0.22 * max(0.0, dot(n, kFill));
  float gleam = max(0.0, dot(n, kHalfway));
  gleam *= gleam;
  gleam *= gleam;
  gleam *= gleam;
  color = vec4(base * light + 0.14 * gleam * gleam, rgba.a);
}
