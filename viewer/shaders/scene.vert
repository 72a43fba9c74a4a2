#version 330 core
// Compiled in four variants: SECTION cuts the model open, COLORED takes colours from its vertices.
uniform mat4 clip_from_model;
uniform mat4 view_from_model;
layout(location = 0) in vec3 position_mm;
layout(location = 1) in vec3 normal_model;
out vec3 normal_view;

#ifdef SECTION
uniform vec4 section;  // what lies where dot(section, (position, 1)) < 0 is taken away
#endif

#ifdef COLORED
uniform int source;    // 0: height, 1: move, 2: deviation
uniform vec2 heights;  // 0 and 1 / mm: from z to 0 .. 1
uniform float tolerance_mm;
uniform int move_count;
uniform vec3 other_rgb;
uniform vec3 not_cut_rgb;
uniform sampler2D move_colors;  // row by row
layout(location = 2) in uint cut_by;
layout(location = 3) in float deviation_mm;
flat out vec3 move_rgb;  // one for the triangle: that of its last corner
out float measure;

vec3 color_of(uint move) {
  if (move == 0xffffffffu) return not_cut_rgb;
  if (move >= uint(move_count)) return other_rgb;
  int width = textureSize(move_colors, 0).x;
  return texelFetch(move_colors, ivec2(int(move) % width, int(move) / width), 0).rgb;
}
#endif

void main() {
  normal_view = mat3(view_from_model) * normal_model;
  gl_Position = clip_from_model * vec4(position_mm, 1.0);
#ifdef SECTION
  gl_ClipDistance[0] = dot(section, vec4(position_mm, 1.0));
#endif
#ifdef COLORED
  move_rgb = source == 1 ? color_of(cut_by) : vec3(0.0);
  measure = source == 2 ? deviation_mm / tolerance_mm : (position_mm.z - heights.x) * heights.y;
#endif
}
