#version 330 core
// One pass, cheap enough for software renderers: sky, two lamps and a soft gleam, all at the
// corners, since the triangles of what is curved are about as small as pixels.
// Variants: SECTION cuts the model open, TWO_SIDED lights backs as well; at most one of
// BY_CUT (cut or not), BY_MOVE (the move that cut) and BY_MEASURE (height or deviation) gives the
// colours.
uniform mat4 clip_from_model;
uniform mat4 view_from_model;
uniform vec3 up_view;  // +Z of the workpiece
layout(location = 0) in vec3 position_mm;
layout(location = 1) in vec3 normal_model;
out vec2 front_light;  // what the colour is multiplied by, what is added to it
#ifdef TWO_SIDED
out vec2 back_light;
#endif

#ifdef SECTION
uniform vec4 section;  // what lies where dot(section, (position, 1)) < 0 is taken away
#endif

#if defined(BY_CUT) || defined(BY_MOVE)
uniform vec3 other_rgb;
uniform vec3 not_cut_rgb;
layout(location = 2) in uint cut_by;
flat out vec3 move_rgb;  // one for the triangle: that of its last corner
#endif

#ifdef BY_MOVE
uniform int move_count;
uniform sampler2D move_colors;  // row by row

vec3 color_of(uint move) {
  if (move == 0xffffffffu) return not_cut_rgb;
  if (move >= uint(move_count)) return other_rgb;
  int width = textureSize(move_colors, 0).x;
  return texelFetch(move_colors, ivec2(int(move) % width, int(move) / width), 0).rgb;
}
#endif

#ifdef BY_MEASURE
uniform int is_deviation;
uniform vec2 heights;  // 0 and 1 / mm: from z to 0 .. 1
uniform float tolerance_mm;
layout(location = 3) in float deviation_mm;
out float measure;
#endif

const vec3 kKey = vec3(-0.6210, 0.3506, 0.7011);  // directions to the lamps, view space
const vec3 kFill = vec3(0.8136, 0.2034, 0.5447);
const vec3 kHalfway = vec3(-0.3367, 0.1901, 0.9222);  // between the key lamp and the eye

vec2 light_on(vec3 n) {
  float sky = 0.36 + 0.14 * dot(n, up_view);
  float light = sky + 0.50 * max(0.0, dot(n, kKey)) + 0.22 * max(0.0, dot(n, kFill));
  float gleam = max(0.0, dot(n, kHalfway));
  gleam *= gleam;
  gleam *= gleam;
  gleam *= gleam;
  return vec2(light, 0.14 * gleam * gleam);
}

void main() {
  vec3 n = mat3(view_from_model) * normal_model;
  n *= inversesqrt(max(dot(n, n), 1e-6));
  front_light = light_on(n);
#ifdef TWO_SIDED
  back_light = light_on(-n);
#endif
  gl_Position = clip_from_model * vec4(position_mm, 1.0);
#ifdef SECTION
  gl_ClipDistance[0] = dot(section, vec4(position_mm, 1.0));
#endif
#ifdef BY_CUT
  move_rgb = cut_by == 0xffffffffu ? not_cut_rgb : other_rgb;
#endif
#ifdef BY_MOVE
  move_rgb = color_of(cut_by);
#endif
#ifdef BY_MEASURE
  measure = is_deviation == 1 ? deviation_mm / tolerance_mm
                              : (position_mm.z - heights.x) * heights.y;
#endif
}
