#version 330 core
uniform mat4 clip_from_world;
uniform float towards_eye;  // in clip coordinates: lines that lie in a surface are seen on it
uniform int is_past;        // 1: the tool has passed what is drawn
uniform vec4 rgba[6];       // by kind, past before future
uniform int by_move;        // 1: feeds have the colours of their moves
uniform int move_count;
uniform sampler2D move_colors;  // row by row
uniform vec3 other_rgb;         // of moves beyond them
uniform vec4 ground;            // and the share of it in what is not past
layout(location = 0) in vec3 position_mm;
layout(location = 1) in uint kind_and_move;  // PathVertex: 2 bits, 30 bits
flat out vec4 line_rgba;

vec3 color_of(uint move) {
  if (move >= uint(move_count)) return other_rgb;
  int width = textureSize(move_colors, 0).x;
  return texelFetch(move_colors, ivec2(int(move) % width, int(move) / width), 0).rgb;
}

void main() {
  uint kind = kind_and_move & 3u;
  line_rgba = rgba[min(kind, 2u) * 2u + (is_past != 0 ? 0u : 1u)];
  if (by_move != 0 && kind != 0u) {
    vec3 seen = color_of(kind_and_move >> 2u);
    line_rgba.rgb = is_past != 0 ? seen : mix(seen, ground.rgb, ground.a);
  }
  gl_Position = clip_from_world * vec4(position_mm, 1.0);
  gl_Position.z -= towards_eye;
}
