#version 330 core
// The cut face of a section, hatched as in a technical drawing, at the depth of its plane.
uniform vec3 depth_plane;  // window depth = x * px.x + y * px.y + z, pixels from the middle
uniform vec2 middle_px;
out vec4 color;

const float kPitch_px = 9.0;
const vec3 kFace = vec3(0.91, 0.72, 0.50);
const vec3 kLine = vec3(0.66, 0.42, 0.22);

void main() {
  float across = abs(mod(gl_FragCoord.x + gl_FragCoord.y, kPitch_px) - 0.5 * kPitch_px);
  color = vec4(mix(kLine, kFace, smoothstep(0.6, 1.7, across)), 1.0);
  vec3 at = vec3(gl_FragCoord.xy - middle_px, 1.0);
  gl_FragDepth = clamp(dot(depth_plane, at), 0.0, 1.0);
}
