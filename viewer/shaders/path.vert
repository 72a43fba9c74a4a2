#version 330 core
uniform mat4 clip_from_world;
uniform float towards_eye;  // in clip coordinates: lines that lie in a surface are seen on it
uniform int is_past;        // 1: the tool has passed what is drawn
uniform vec4 rgba[6];       // by kind, past before future
layout(location = 0) in vec3 position_mm;
layout(location = 1) in uint kind;
flat out vec4 line_rgba;

void main() {
  line_rgba = rgba[min(kind, 2u) * 2u + (is_past != 0 ? 0u : 1u)];
  gl_Position = clip_from_world * vec4(position_mm, 1.0);
  gl_Position.z -= towards_eye;
}
