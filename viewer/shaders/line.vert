#version 330 core
// Lines as rectangles with round ends, six vertices each, for lines that are wider than the one pixel
// of OpenGL's own. Their ends are read from a buffer: x, y, z and the bits of a colour or a kind.
uniform usamplerBuffer ends;
uniform usamplerBuffer numbers;
uniform int is_numbered;    // 1: strips are of the ends with these numbers
uniform mat4 clip_from_world;
uniform float towards_eye;  // in clip coordinates: lines that lie in a surface are seen on it
uniform vec2 picture_px;
uniform float half_px;      // of the width
uniform int step;           // from a line's beginning to the next one's: 1 in a strip, 2 between pairs
uniform ivec2 single;       // both ends of the only line; else -1
uniform int by_kind;        // 1: coloured by kind as path.vert, 0: by a colour of its own as marker.vert
uniform int is_past;
uniform vec4 rgba[6];
uniform float opacity;
uniform int by_move;  // from here on as in path.vert
uniform int move_count;
uniform sampler2D move_colors;
uniform vec3 other_rgb;
uniform vec4 ground;
noperspective out vec2 local_px;  // along the line from its beginning, and across
flat out float length_px;
flat out vec4 line_rgba;

const float kLeastW = 1e-4;
// Of half the picture, from its middle: lines are cut off so far out, since far numbers are rough.
const float kFarthest = 4.0;

vec4 clip_of(uvec4 end) {
  vec4 clip = clip_from_world * vec4(uintBitsToFloat(end.xyz), 1.0);
  clip.z -= towards_eye;
  return clip;
}

vec3 color_of_move(uint move) {
  if (move >= uint(move_count)) return other_rgb;
  int width = textureSize(move_colors, 0).x;
  return texelFetch(move_colors, ivec2(int(move) % width, int(move) / width), 0).rgb;
}

vec4 color_of(uint bits) {
  if (by_kind != 0) {
    uint kind = bits & 3u;
    vec4 plain = rgba[min(kind, 2u) * 2u + (is_past != 0 ? 0u : 1u)];
    if (by_move == 0 || kind == 0u) return plain;
    vec3 seen = color_of_move(bits >> 2u);
    return vec4(is_past != 0 ? seen : mix(seen, ground.rgb, ground.a), plain.a);
  }
  vec4 bytes = vec4((uvec4(bits) >> uvec4(0u, 8u, 16u, 24u)) & 255u) / 255.0;
  return vec4(bytes.rgb, bytes.a * opacity);
}

// Distances to the five planes of what is drawn; inside they are positive.
float inside(vec4 clip, int plane) {
  if (plane == 0) return clip.w - kLeastW;
  float at = plane < 3 ? clip.x : clip.y;
  return kFarthest * clip.w + (plane % 2 == 1 ? at : -at);
}

void main() {
  int corner = gl_VertexID % 6, first = gl_VertexID / 6 * step;
  ivec2 at = single.x >= 0 ? single : ivec2(first, first + 1);
  if (is_numbered != 0 && single.x < 0) {
    at = ivec2(texelFetch(numbers, at.x).r, texelFetch(numbers, at.y).r);
  }
  uvec4 from = texelFetch(ends, at.x), to = texelFetch(ends, at.y);
  line_rgba = color_of(to.w);
  vec4 a = clip_of(from), b = clip_of(to);
  gl_Position = vec4(2.0, 2.0, 2.0, 1.0);  // beside the picture
  local_px = vec2(0.0);
  length_px = 0.0;
  if (line_rgba.a == 0.0) return;
  for (int plane = 0; plane < 5; ++plane) {
    float in_a = inside(a, plane), in_b = inside(b, plane);
    if (in_a < 0.0 && in_b < 0.0) return;
    vec4 edge = mix(a, b, in_a / (in_a - in_b));
    if (in_a < 0.0) a = edge;
    if (in_b < 0.0) b = edge;
  }
  vec2 a_px = a.xy / a.w * 0.5 * picture_px, b_px = b.xy / b.w * 0.5 * picture_px;
  length_px = distance(a_px, b_px);
  vec2 along = length_px > 1e-6 ? (b_px - a_px) / length_px : vec2(1.0, 0.0);
  float reach = half_px + 0.5;  // with the rim that is partly covered
  bool is_end = corner == 1 || corner == 2 || corner == 4;
  float side = (corner == 2 || corner == 4 || corner == 5) ? reach : -reach;
  local_px = vec2(is_end ? length_px + reach : -reach, side);
  vec2 place_px = a_px + along * local_px.x + vec2(-along.y, along.x) * side;
  gl_Position = vec4(place_px / (0.5 * picture_px), is_end ? b.z / b.w : a.z / a.w, 1.0);
}
