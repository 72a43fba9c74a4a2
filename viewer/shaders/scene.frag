#version 330 core
// Colours under the light of scene.vert.
uniform vec4 rgba;
in vec2 front_light;
out vec4 color;

#ifdef TWO_SIDED
in vec2 back_light;
#endif

#ifdef BESIDE_GLASS
// Drawn over a transparent workpiece in two turns: what lies behind its surface, what lies before.
uniform sampler2D glass_depths;
uniform int is_behind;
#endif

#if defined(BY_CUT) || defined(BY_MOVE)
flat in vec3 move_rgb;
#endif

#ifdef BY_MEASURE
uniform int is_deviation;
uniform vec3 stops[5];  // heights: evenly from 0 to 1; deviations: -2, -1 (the tolerance), 0, 1, 2
in float measure;

vec3 height_rgb() {
  float at = clamp(measure, 0.0, 1.0) * 4.0;
  int first = min(int(at), 3);
  return mix(stops[first], stops[first + 1], at - float(first));
}

vec3 deviation_rgb() {
  float beyond = clamp(abs(measure) - 1.0, 0.0, 1.0);
  if (beyond == 0.0) return stops[2];
  return measure < 0.0 ? mix(stops[1], stops[0], beyond) : mix(stops[3], stops[4], beyond);
}
#endif

void main() {
#ifdef BESIDE_GLASS
  bool lies_behind = gl_FragCoord.z >= texelFetch(glass_depths, ivec2(gl_FragCoord.xy), 0).r;
  if (lies_behind != (is_behind == 1)) discard;
#endif
#if defined(BY_CUT) || defined(BY_MOVE)
  vec3 base = move_rgb;
#elif defined(BY_MEASURE)
  vec3 base = is_deviation == 1 ? deviation_rgb() : height_rgb();
#else
  vec3 base = rgba.rgb;
#endif
#ifdef TWO_SIDED
  vec2 light = gl_FrontFacing ? front_light : back_light;
#else
  vec2 light = front_light;
#endif
  color = vec4(base * light.x + light.y, rgba.a);
}
