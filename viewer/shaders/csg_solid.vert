#version 330 core
// Flat faces: lit once per face, at its first corner, so that pixels cost nothing but the test.
uniform mat4 clip_from_world;
uniform mat4 view_from_world;
layout(location = 0) in vec3 position_mm;
layout(location = 1) in vec4 normal_world;
layout(location = 2) in vec4 face_color;
flat out vec3 shade;

const vec3 kKey = vec3(-0.6210, 0.3506, 0.7011);  // the lamps of scene.frag, view space
const vec3 kFill = vec3(0.8136, 0.2034, 0.5447);
const vec3 kHalfway = vec3(-0.3367, 0.1901, 0.9222);

void main() {
  vec3 n = normalize(mat3(view_from_world) * normal_world.xyz);
  float sky = 0.36 + 0.14 * dot(n, view_from_world[2].xyz);
  float light = sky + 0.50 * max(0.0, dot(n, kKey)) + 0.22 * max(0.0, dot(n, kFill));
  float gleam = max(0.0, dot(n, kHalfway));
  gleam *= gleam;
  gleam *= gleam;
  gleam *= gleam;
  shade = face_color.rgb * light + 0.14 * gleam * gleam;
  gl_Position = clip_from_world * vec4(position_mm, 1.0);
}
