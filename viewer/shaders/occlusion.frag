#version 330 core
// Scalable ambient obscurance (McGuire, Mara, Luebke, HPG 2012), few taps, at half the resolution.
// The taps are turned by a 4x4 pattern; the composite pass averages the pattern away.
uniform sampler2D normals;
uniform sampler2D depths;
uniform vec4 unproject;          // x, y: 1 / P00, 1 / P11; distance = 1 / (z + w * depth)
uniform float radius_mm;
uniform float radius_px_at_1mm;  // radius_mm in pixels of the picture, seen from 1 mm away
out vec4 result;

const int kTaps = 10;
const float kBias = 0.06;        // sine of the angle above the surface that does not occlude
const float kStrength = 3.2;

vec3 position_view(ivec2 px, vec2 size_px) {
  vec2 at = (vec2(px) + 0.5) / size_px;
  float distance_mm = 1.0 / (unproject.z + unproject.w * texture(depths, at).r);
  return vec3((at * 2.0 - 1.0) * unproject.xy, -1.0) * distance_mm;
}

void main() {
  vec2 size_px = vec2(textureSize(depths, 0));
  ivec2 px = min(2 * ivec2(gl_FragCoord.xy), ivec2(size_px) - 1);
  vec3 n = texelFetch(normals, px, 0).xyz;
  n *= inversesqrt(max(dot(n, n), 1e-6));
  vec3 p = position_view(px, size_px);
  float radius_px = radius_px_at_1mm / -p.z;
  ivec2 cell = ivec2(gl_FragCoord.xy) & 3;
  int scrambled = (cell.x * 4 + cell.y * 7 + (cell.x ^ cell.y) * 9) & 15;
  float turn = float(scrambled) * (6.2831853 / 16.0);
  float sum = 0.0;
  for (int i = 0; i < kTaps; ++i) {
    float along = (float(i) + 0.5) / float(kTaps);
    float angle = float(i) * 2.3999632 + turn;  // golden angle
    vec2 offset_px = along * radius_px * vec2(cos(angle), sin(angle));
    vec3 v = position_view(px + ivec2(floor(offset_px + 0.5)), size_px) - p;
    float vv = dot(v, v);
    float falloff = max(0.0, 1.0 - vv / (radius_mm * radius_mm));
    sum += falloff * max(0.0, dot(v, n) * inversesqrt(vv + 1e-6) - kBias);
  }
  result = vec4(max(0.0, 1.0 - kStrength * sum / float(kTaps)));
}
