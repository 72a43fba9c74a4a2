#version 330 core
// Lines and round markers with a colour of their own.
uniform mat4 clip_from_world;
uniform float towards_eye;  // in clip coordinates: lines that lie in a surface are seen on it
uniform float opacity;
uniform float size_px;  // of markers
layout(location = 0) in vec3 position_mm;
layout(location = 1) in vec4 vertex_rgba;
out vec4 marker_rgba;

void main() {
  marker_rgba = vec4(vertex_rgba.rgb, vertex_rgba.a * opacity);
  gl_PointSize = size_px;
  gl_Position = clip_from_world * vec4(position_mm, 1.0);
  gl_Position.z -= towards_eye;
}
