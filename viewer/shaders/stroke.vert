#version 330 core
uniform vec2 picture_px;
layout(location = 0) in vec3 position;  // px from the upper left; depth (below 0: always in front)
layout(location = 1) in vec4 shape;     // px along and across the axis of the stroke; length, half width
layout(location = 2) in vec4 rgba;
layout(location = 3) in float hidden_alpha;
out vec2 local_px;
flat out vec2 extent_px;
flat out vec4 stroke_rgba;
flat out float stroke_hidden_alpha;
out float depth;

void main() {
  local_px = shape.xy;
  extent_px = shape.zw;
  stroke_rgba = rgba;
  stroke_hidden_alpha = hidden_alpha;
  depth = position.z;
  vec2 ndc = position.xy / picture_px * 2.0 - 1.0;
  gl_Position = vec4(ndc.x, -ndc.y, 0.0, 1.0);
}
