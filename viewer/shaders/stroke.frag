#version 330 core
uniform sampler2D depths;
uniform float depth_bias;
in vec2 local_px;
flat in vec2 extent_px;
flat in vec4 stroke_rgba;
flat in float stroke_hidden_alpha;
in float depth;
out vec4 color;

// Share of the neighbourhood that leaves the stroke visible: a soft version of the depth test.
float visible() {
  if (depth < 0.0) return 1.0;
  ivec2 at = ivec2(gl_FragCoord.xy), last = textureSize(depths, 0) - 1;
  ivec2 offsets[5] = ivec2[5](ivec2(0), ivec2(1, 0), ivec2(-1, 0), ivec2(0, 1), ivec2(0, -1));
  float sum = 0.0;
  for (int i = 0; i < 5; ++i) {
    float part = texelFetch(depths, clamp(at + offsets[i], ivec2(0), last), 0).r;
    sum += step(depth, part + depth_bias);
  }
  return sum / 5.0;
}

void main() {
  // Distance to the segment from (0, 0) to (length, 0), and one pixel of transition around the width.
  vec2 d = vec2(local_px.x - clamp(local_px.x, 0.0, extent_px.x), local_px.y);
  float cover = clamp(extent_px.y + 0.5 - length(d), 0.0, 1.0);
  float alpha = stroke_rgba.a * mix(stroke_hidden_alpha, 1.0, visible());
  color = vec4(stroke_rgba.rgb, alpha * cover);
}
