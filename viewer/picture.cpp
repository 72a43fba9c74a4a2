#include "viewer/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <mutex>

#include "base/atomic_file.h"
#include "base/translate.h"
#include "viewer/annotations.h"
#include "viewer/body_layer.h"
#include "viewer/camera.h"
#include "viewer/gl_context.h"
#include "viewer/gl_objects.h"
#include "viewer/part_renderer.h"
#include "viewer/png_image.h"
#include "viewer/render_target.h"
#include "viewer/stroke_renderer.h"

namespace kerf {
namespace {

constexpr int kMinSize_px = 64;
constexpr int kMaxSize_px = 8192;
constexpr double kFieldOfView_deg = 24.0;
/// Of what stands around the blank so much of the blank's greatest length is shown.
constexpr double kBodyReach = 0.4;
/// What holds a part that turns is round, and wider than the part on all sides.
constexpr double kBodyReachInLathe = 0.15;
/// From front right above, towards the eye, in the frame of views.
constexpr Vec3 kEyeDirection{0.60, -1.0, 0.86};

/// What a pixel shows of that corner of the box which is nearest to the eye.
double smallest_pixel_mm(const Camera& camera, const Box& box) {
  float nearest_mm = camera.distance_mm();
  for (unsigned corner = 0; corner < 8; ++corner) {
    const glm::vec4 at((corner & 1u) ? box.max.x : box.min.x, (corner & 2u) ? box.max.y : box.min.y,
                       (corner & 4u) ? box.max.z : box.min.z, 1.0);
    nearest_mm = std::min(nearest_mm, -(camera.view_from_world() * at).z);
  }
  return static_cast<double>(camera.px_mm_at_1mm() * nearest_mm);
}

/// The corners of what of the bodies lies near the blank: a table is not to make the part small.
void add_bodies(const PictureOptions& options, std::vector<Vec3>& points_mm) {
  const Vec3 size = options.blank_mm.empty() ? Vec3(0) : options.blank_mm.size();
  const double share = options.standing == Standing::kOnTable ? kBodyReach : kBodyReachInLathe;
  const double reach_mm = share * std::max({size.x, size.y, size.z});
  for (const PictureBody& body : options.bodies) {
    if (!body.mesh) continue;
    Box box;
    for (const glm::vec3& p : body.mesh->positions_mm)
      box.extend(Vec3(body.pose * glm::vec4(p, 1.0f)));
    for (int axis = 0; axis < 3; ++axis) {
      box.min[axis] = std::max(box.min[axis], options.blank_mm.min[axis] - reach_mm);
      box.max[axis] = std::min(box.max[axis], options.blank_mm.max[axis] + reach_mm);
    }
    if (box.empty()) continue;
    for (unsigned corner = 0; corner < 8; ++corner) {
      points_mm.emplace_back((corner & 1u) ? box.max.x : box.min.x,
                             (corner & 2u) ? box.max.y : box.min.y,
                             (corner & 4u) ? box.max.z : box.min.z);
    }
  }
}

}  // namespace

Result<Picture> draw_part(const PartPatches& part, const PictureOptions& options) {
  const glm::ivec2 size_px(options.width_px, options.height_px);
  if (std::min(size_px.x, size_px.y) < kMinSize_px ||
      std::max(size_px.x, size_px.y) > kMaxSize_px) {
    return Error{trf("a picture of {} x {} pixels is not allowed; each side must be {} to {}",
                     size_px.x, size_px.y, kMinSize_px, kMaxSize_px)};
  }
  if (part.bounds_mm.empty() && options.blank_mm.empty()) {
    return Error{tr("nothing to draw: the part is empty and no blank is given")};
  }
  const Vec3 direction = in_workpiece(kEyeDirection, options.standing);
  Annotations annotations(options.blank_mm, part.bounds_mm, direction, size_px, options.standing);
  annotations.set_outline(options.blank_outline);
  std::vector<Vec3> points_mm = annotations.points_to_fit();
  add_bodies(options, points_mm);
  const Camera camera = Camera::fit(points_mm, direction, kFieldOfView_deg, size_px,
                                    annotations.margins(), up_of(options.standing));

  static std::mutex one_context_at_a_time;  // see GlContext
  const std::lock_guard lock(one_context_at_a_time);
  Result<GlContext> context = GlContext::create_offscreen();
  if (!context) return Error{context.error()};
  Result<PartRenderer> renderer = PartRenderer::create(
      size_px, usual_section(options.section, part.bounds_mm, options.standing));
  if (!renderer) return Error{renderer.error()};
  Result<StrokeRenderer> strokes = StrokeRenderer::create();
  if (!strokes) return Error{strokes.error()};

  GlFramebuffer framebuffer;
  GlRenderbuffer pixels;
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
  glBindRenderbuffer(GL_RENDERBUFFER, pixels.name());
  glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, size_px.x, size_px.y);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, pixels.name());
  const double pixel_mm = smallest_pixel_mm(camera, part.bounds_mm);
  const PartSurface surface{part.bounds_mm, [&](const auto& draw) {
                              for (std::size_t n = 0; n < part.count; ++n) {
                                const MeshPatch patch = part.make(n, pixel_mm);
                                draw({patch.vertices, patch.surface_indices()});
                              }
                            }};
  renderer->draw(surface, camera, framebuffer.name());
  if (!options.bodies.empty()) {
    const Result<BodyLayer> layer = BodyLayer::create();
    if (!layer) return Error{layer.error()};
    const Done done =
        layer->draw(options.bodies, camera, renderer->depths(), size_px, framebuffer.name());
    if (!done) return Error{done.error()};
  }
  strokes->draw(annotations.layout(camera, options.caption), size_px, renderer->depths());
  Picture picture = read_framebuffer(framebuffer.name(), size_px);
  if (const GLenum error = glGetError(); error != GL_NO_ERROR) {
    return Error{trf("OpenGL error 0x{:04X} while drawing a picture of {} x {} pixels", error,
                     size_px.x, size_px.y)};
  }
  return picture;
}

Done write_png(const std::string& path, const Picture& picture) {
  Result<std::vector<std::uint8_t>> bytes = encode_png(picture);
  if (!bytes) return Error{trf("writing {}: {}", path, bytes.error())};
  Result<AtomicFile> file = AtomicFile::create(path);
  if (!file) return Error{file.error()};
  file->write(bytes->data(), bytes->size());
  return file->commit();
}

}  // namespace kerf
