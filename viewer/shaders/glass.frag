#version 330 core
// Lays the transparent workpiece, of which only the nearest surface is kept, over what is drawn.
uniform sampler2D glass_colors;
uniform sampler2D glass_depths;
uniform float opacity;
out vec4 color;

void main() {
  ivec2 px = ivec2(gl_FragCoord.xy);
  float depth = texelFetch(glass_depths, px, 0).r;
  if (depth >= 1.0) discard;
  color = vec4(texelFetch(glass_colors, px, 0).rgb, opacity);
  gl_FragDepth = depth;
}
