#version 330 core
uniform mat4 clip_from_world;
uniform float towards_eye;  // in clip coordinates: lines that lie in a surface are seen on it
uniform int first_vertex;  // of the chunk, in the path
uniform int stride;        // vertices of the path from one drawn vertex to the next
uniform int past_vertices;
uniform vec4 rgba[6];      // by kind, past before future
layout(location = 0) in vec3 position_mm;
layout(location = 1) in uint kind;
flat out vec4 line_rgba;

void main() {
  bool is_past = first_vertex + gl_VertexID * stride < past_vertices;
  line_rgba = rgba[min(kind, 2u) * 2u + (is_past ? 0u : 1u)];
  gl_Position = clip_from_world * vec4(position_mm, 1.0);
  gl_Position.z -= towards_eye;
}
