#version 330 core
// Finds sharp edges and silhouettes in the resolved normals and depths: 0 where the surface is smooth,
// 1 on an edge. What is smaller than a pixel has been averaged away and makes no lines.
uniform sampler2D normals;
uniform sampler2D depths;
uniform vec4 unproject;      // as in occlusion.frag
uniform float px_mm_at_1mm;  // edge of one pixel, seen from 1 mm away
uniform float reach_px;      // whole pixels
in vec2 uv;
out vec4 result;

// Difference of normals, as 1 - cos, at which an edge begins to show and is fully drawn (33, 58 deg).
const float kEdgeBegin = 0.16;
const float kEdgeFull = 0.47;
// Jump of depth, in pixels, at which a silhouette begins to show; fully drawn at twice that.
const float kJumpBegin_px = 4.0;

float distance_mm(float depth) { return 1.0 / (unproject.z + unproject.w * depth); }

vec3 unit(vec3 v) { return v * inversesqrt(max(dot(v, v), 1e-6)); }

void main() {
  float depth = texture(depths, uv).r;
  vec2 one_px = 1.0 / vec2(textureSize(depths, 0));
  float at_mm = distance_mm(depth);
  float begin_mm = kJumpBegin_px * px_mm_at_1mm * at_mm;
  float crease = 0.0, deepest = depth;
  vec2 offsets[4] = vec2[4](vec2(1, 0), vec2(0, 1), vec2(1, 1), vec2(1, -1));
  for (int i = 0; i < 4; ++i) {
    vec2 a = uv + reach_px * one_px * offsets[i], b = uv - reach_px * one_px * offsets[i];
    vec4 na = texture(normals, a), nb = texture(normals, b);
    float both = step(0.5, min(na.a, nb.a));
    crease = max(crease, both * (1.0 - dot(unit(na.xyz), unit(nb.xyz))));
    // Depth is affine in the picture on a plane, so the mean of two opposite pixels equals it there.
    // Signed: only the nearer side of a jump is drawn.
    deepest = max(deepest, 0.5 * (texture(depths, a).r + texture(depths, b).r));
  }
  float jump_mm = distance_mm(deepest) - at_mm;
  result = vec4(max(smoothstep(kEdgeBegin, kEdgeFull, crease),
                    smoothstep(begin_mm, 2.0 * begin_mm, jump_mm)));
}
