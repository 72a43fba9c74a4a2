#version 330 core
// The face of a section for the normals of the part (part.frag), at the depth of its plane.
uniform vec3 normal_view;
uniform vec3 depth_plane;  // window depth = x * px.x + y * px.y + z, pixels from the middle
uniform vec2 middle_px;
uniform vec3 kept_beside;  // above 0: there the other plane keeps what this one would take
out vec4 normal_coverage;

void main() {
  vec3 at = vec3(gl_FragCoord.xy - middle_px, 1.0);
  if (dot(kept_beside, at) > 0.0) discard;
  normal_coverage = vec4(0.5 + 0.5 * normal_view, 1.0);
  gl_FragDepth = clamp(dot(depth_plane, at), 0.0, 1.0);
}
