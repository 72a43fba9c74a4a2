#version 330 core
uniform mat4 clip_from_model;
uniform mat4 view_from_model;
layout(location = 0) in vec3 position_mm;
layout(location = 1) in vec3 normal_model;
out vec3 normal_view;

void main() {
  normal_view = mat3(view_from_model) * normal_model;
  gl_Position = clip_from_model * vec4(position_mm, 1.0);
}
