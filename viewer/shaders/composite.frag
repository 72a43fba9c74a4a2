#version 330 core
// Lights the averaged normals as milled aluminium in a bright room and darkens sharp edges and
// silhouettes. Alpha is the coverage.
uniform sampler2D normals;
uniform sampler2D occlusion;
uniform sampler2D edges;
uniform vec4 unproject;  // as in occlusion.frag
uniform vec3 up_view;    // what is up in the workpiece frame
uniform float edge_strength;
uniform float dense_level;  // of the edges' mipmap: a texel covers that many lines beside each other
// Faces of a section, hatched: planes in view space, dot(face, (p, 1)) = 0, facing the eye.
uniform int face_count;
uniform vec4 faces[2];
uniform sampler2D depths;
uniform float px_mm_at_1mm;
uniform float hatch_px;  // from line to line
in vec2 uv;
out vec4 color;

const vec3 kHatched = vec3(0.91, 0.72, 0.50);
const vec3 kHatch = vec3(0.66, 0.42, 0.22);

// Share of the picture around that edges cover, from which on they are drawn paler, and are as pale
// as they get. A corner of a part is below; where terraces or tracks lie as close as the lines are
// wide, lines would leave nothing to be seen of them.
const float kDense = 0.12;
const float kDensest = 0.36;
const float kDensestStrength = 0.15;

const vec3 kKey = vec3(-0.6210, 0.3506, 0.7011);  // directions to the lamps, view space
const vec3 kFill = vec3(0.8136, 0.2034, 0.5447);
const vec3 kPanel = vec3(-0.4200, 0.8600, -0.2890);  // behind the part, seen only as a reflection
// The room is reflected as if the eye were this much closer: flat faces get a gradient, as they do
// from lamps that are not infinitely far away.
const float kNearRoom = 2.6;

vec3 unit(vec3 v) { return v * inversesqrt(max(dot(v, v), 1e-6)); }

// Brightness of the room in direction r: light ceiling, grey floor, lamps.
float room(vec3 r) {
  float base = mix(0.12, 0.50, smoothstep(-1.00, 0.90, dot(r, up_view)));
  float key = smoothstep(0.40, 0.98, dot(r, kKey));
  float fill = smoothstep(0.40, 1.00, dot(r, kFill));
  float panel = smoothstep(0.55, 1.00, dot(r, kPanel));
  return base + 0.90 * key + 0.35 * fill + 0.55 * panel;
}

vec3 lit(vec3 n, vec3 to_eye, vec3 to_near_eye, float open) {
  float sky = mix(0.20, 0.46, 0.5 + 0.5 * dot(n, up_view));
  float key = max(0.0, dot(n, kKey));
  float fill = max(0.0, dot(n, kFill));
  float diffuse = sky * open + (0.50 * key + 0.15 * fill) * mix(0.5, 1.0, open);
  float grazing = 1.0 - clamp(dot(n, to_eye), 0.0, 1.0);
  grazing *= grazing;
  float mirror = room(reflect(-to_near_eye, n)) * mix(0.3, 1.0, open);
  return vec3(0.430, 0.444, 0.462) * diffuse +
         vec3(0.320, 0.327, 0.335) * mirror * (0.85 + 0.5 * grazing * grazing);
}

// Mean of four bilinear taps around `at`, `reach` texels away.
float blurred(sampler2D image, vec2 at, float reach) {
  vec2 step_uv = reach / vec2(textureSize(image, 0));
  vec2 other = vec2(step_uv.x, -step_uv.y);
  return 0.25 * (texture(image, at + step_uv).r + texture(image, at - step_uv).r +
                 texture(image, at + other).r + texture(image, at - other).r);
}

bool is_on_face(vec3 normal, vec2 tangent) {
  float depth = texture(depths, uv).r;
  float distance_mm = 1.0 / (unproject.z + unproject.w * depth);
  vec4 at = vec4(-tangent * distance_mm, -distance_mm, 1.0);
  for (int i = 0; i < face_count; ++i) {
    bool is_near = abs(dot(faces[i], at)) < 0.5 * px_mm_at_1mm * distance_mm;
    if (is_near && dot(normal, faces[i].xyz) > 0.99) return true;
  }
  return false;
}

void main() {
  vec4 g = texture(normals, uv);
  // Taps one texel from a corner average exactly the 4 x 4 texels of the occlusion pattern.
  vec2 texels = vec2(textureSize(occlusion, 0));
  vec2 corner = floor(uv * texels + 0.5) / texels;
  float open = blurred(occlusion, corner, 1.0);
  float edge = blurred(edges, uv, 0.5);  // 3 x 3 tent: antialiases the lines
  float density = textureLod(edges, uv, dense_level).r;
  edge *= mix(1.0, kDensestStrength, smoothstep(kDense, kDensest, density));
  vec2 tangent = (1.0 - uv * 2.0) * unproject.xy;
  vec3 linear =
      lit(unit(g.xyz), unit(vec3(tangent, 1.0)), unit(vec3(kNearRoom * tangent, 1.0)), open);
  vec3 surface = sqrt(clamp(linear, 0.0, 1.0));  // about the sRGB curve
  if (face_count > 0 && is_on_face(unit(g.xyz), tangent)) {
    float across = abs(mod(gl_FragCoord.x + gl_FragCoord.y, hatch_px) - 0.5 * hatch_px);
    surface = mix(kHatch, kHatched, smoothstep(0.07 * hatch_px, 0.19 * hatch_px, across));
  }
  color = vec4(surface * (1.0 - edge_strength * edge), g.a);
}
