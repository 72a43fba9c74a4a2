#version 330 core
// What is left of one layer of the blank, laid over the layers that were drawn before.
uniform sampler2D colors;  // alpha: 1 where the layer's point is inside the blank
uniform sampler2D depths;
out vec4 color;

void main() {
  ivec2 px = ivec2(gl_FragCoord.xy);
  vec4 kept = texelFetch(colors, px, 0);
  if (kept.a < 0.5) discard;
  color = kept;
  gl_FragDepth = texelFetch(depths, px, 0).r;
}
