#version 330 core
// What stands around a part, as far as the part does not hide it; twice the size of the picture.
// The light is that of scene.frag.
uniform sampler2D part_depths;
uniform vec4 rgba;
in vec2 front_light;
out vec4 color;

void main() {
  if (gl_FragCoord.z >= texelFetch(part_depths, ivec2(gl_FragCoord.xy) / 2, 0).r) discard;
  color = vec4(rgba.rgb * front_light.x + front_light.y, 1.0);
}
