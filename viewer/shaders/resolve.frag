#version 330 core
// Averages 2 x 2 samples: normals (not of unit length afterwards, alpha is the coverage), and the
// depth of those samples that hit the part.
uniform sampler2D normals;
uniform sampler2D depths;
layout(location = 0) out vec4 normal_coverage;
layout(location = 1) out float depth;

void main() {
  ivec2 at = 2 * ivec2(gl_FragCoord.xy);
  ivec2 offsets[4] = ivec2[4](ivec2(0, 0), ivec2(1, 0), ivec2(0, 1), ivec2(1, 1));
  vec4 normal_sum = vec4(0.0);
  float depth_sum = 0.0;
  for (int i = 0; i < 4; ++i) {
    vec4 n = texelFetch(normals, at + offsets[i], 0);
    normal_sum += n.a * vec4(2.0 * n.xyz - 1.0, 1.0);
    depth_sum += n.a * texelFetch(depths, at + offsets[i], 0).r;
  }
  normal_coverage = 0.25 * normal_sum;
  depth = normal_sum.a > 0.0 ? depth_sum / normal_sum.a : 1.0;
}
