#version 330 core
// Only normal and coverage: the samples of a pixel are averaged first and lit afterwards, so that
// triangles smaller than a pixel do not glitter.
in vec3 normal_view;
out vec4 normal_coverage;

void main() { normal_coverage = vec4(0.5 + 0.5 * normalize(normal_view), 1.0); }
