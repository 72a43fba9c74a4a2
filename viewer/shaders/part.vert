#version 330 core
uniform mat4 clip_from_world;
uniform mat4 view_from_world;
layout(location = 0) in vec3 position_mm;
layout(location = 1) in vec3 normal_world;
uniform vec4 section;  // with a clip plane: what lies where dot(section, (position, 1)) < 0 is gone
out vec3 normal_view;

void main() {
  normal_view = mat3(view_from_world) * normal_world;
  gl_ClipDistance[0] = dot(section, vec4(position_mm, 1.0));
  gl_Position = clip_from_world * vec4(position_mm, 1.0);
}
