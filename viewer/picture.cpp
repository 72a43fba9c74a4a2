#include "viewer/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <mutex>

#include "base/atomic_file.h"
#include "viewer/annotations.h"
#include "viewer/camera.h"
#include "viewer/gl_context.h"
#include "viewer/gl_objects.h"
#include "viewer/part_renderer.h"
#include "viewer/png_image.h"
#include "viewer/shaded_mesh.h"
#include "viewer/stroke_renderer.h"

namespace kerf {
namespace {

constexpr int kMinSize_px = 64;
constexpr int kMaxSize_px = 8192;
constexpr double kFieldOfView_deg = 24.0;
/// From front (-Y) right (+X) above, towards the eye.
constexpr Vec3 kEyeDirection{0.60, -1.0, 0.86};
/// Limits in pixels of the size up to which creases are smoothed.
constexpr double kMinCrease_px = 1.4;
constexpr double kMaxCrease_px = 6.0;
/// Size of a zigzag in a wall of a height grid, in cells.
constexpr double kZigzagCells = 1.5;
constexpr std::size_t kSampledTriangles = 20000;

Box bounds_of(const TriangleMesh& mesh) {
  Box box;
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t v : triangle) box.extend(Vec3(mesh.positions_mm[v]));
  }
  return box;
}

/// Length that a tenth of the shortest sides of the triangles stay below: the cell, if the mesh was
/// made from a grid. From a sample.
double fine_edge_mm(const TriangleMesh& mesh) {
  std::vector<float> lengths_mm;
  const std::size_t step = mesh.triangles.size() / kSampledTriangles + 1;
  for (std::size_t t = 0; t < mesh.triangles.size(); t += step) {
    const auto& [a, b, c] = mesh.triangles[t];
    const glm::vec3 p = mesh.positions_mm[a], q = mesh.positions_mm[b], r = mesh.positions_mm[c];
    lengths_mm.push_back(std::min({glm::length(p - q), glm::length(q - r), glm::length(r - p)}));
  }
  if (lengths_mm.empty()) return 0.0;
  const auto tenth = lengths_mm.begin() + static_cast<std::ptrdiff_t>(lengths_mm.size() / 10);
  std::nth_element(lengths_mm.begin(), tenth, lengths_mm.end());
  return static_cast<double>(*tenth);
}

/// The framebuffer's pixels, rows from the top.
Picture read_picture(GLuint framebuffer, glm::ivec2 size_px) {
  Picture picture{size_px.x, size_px.y, {}};
  const std::size_t row_bytes = static_cast<std::size_t>(size_px.x) * 3;
  const auto rows = static_cast<std::size_t>(size_px.y);
  picture.rgb.resize(row_bytes * rows);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, size_px.x, size_px.y, GL_RGB, GL_UNSIGNED_BYTE, picture.rgb.data());
  const auto row = [&](std::size_t y) {
    return picture.rgb.begin() + static_cast<std::ptrdiff_t>(y * row_bytes);
  };
  for (std::size_t y = 0; y < rows / 2; ++y) {
    std::swap_ranges(row(y), row(y + 1), row(rows - 1 - y));
  }
  return picture;
}

}  // namespace

Result<Picture> draw_part(const TriangleMesh& mesh, const PictureOptions& options) {
  const glm::ivec2 size_px(options.width_px, options.height_px);
  if (std::min(size_px.x, size_px.y) < kMinSize_px ||
      std::max(size_px.x, size_px.y) > kMaxSize_px) {
    return Error{
        fmt::format("a picture of {} x {} pixels is not allowed; each side must be {} to {}",
                    size_px.x, size_px.y, kMinSize_px, kMaxSize_px)};
  }
  const Box part_mm = bounds_of(mesh);
  if (part_mm.empty() && options.blank_mm.empty()) {
    return Error{"nothing to draw: the part is empty and no blank is given"};
  }
  const Annotations annotations(options.blank_mm, part_mm, kEyeDirection, size_px);
  const std::vector<Vec3> points_mm = annotations.points_to_fit();
  const Camera camera =
      Camera::fit(points_mm, kEyeDirection, kFieldOfView_deg, size_px, annotations.margins());
  const double px_mm = static_cast<double>(camera.px_mm_at_1mm() * camera.distance_mm());
  ShadingOptions shading;
  shading.smallest_visible_mm =
      std::clamp(kZigzagCells * fine_edge_mm(mesh), kMinCrease_px * px_mm, kMaxCrease_px * px_mm);
  const ShadedMesh shaded = shade_mesh(mesh, shading);

  static std::mutex one_context_at_a_time;  // see GlContext
  const std::lock_guard lock(one_context_at_a_time);
  Result<GlContext> context = GlContext::create_offscreen();
  if (!context) return Error{context.error()};
  Result<PartRenderer> part = PartRenderer::create(size_px);
  if (!part) return Error{part.error()};
  Result<StrokeRenderer> strokes = StrokeRenderer::create();
  if (!strokes) return Error{strokes.error()};

  GlFramebuffer framebuffer;
  GlRenderbuffer pixels;
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
  glBindRenderbuffer(GL_RENDERBUFFER, pixels.name());
  glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, size_px.x, size_px.y);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, pixels.name());
  part->draw(shaded, camera, framebuffer.name());
  strokes->draw(annotations.layout(camera, options.caption), size_px, part->depths());
  Picture picture = read_picture(framebuffer.name(), size_px);
  if (const GLenum error = glGetError(); error != GL_NO_ERROR) {
    return Error{fmt::format("OpenGL error 0x{:04X} while drawing a picture of {} x {} pixels",
                             error, size_px.x, size_px.y)};
  }
  return picture;
}

Done write_png(const std::string& path, const Picture& picture) {
  Result<std::vector<std::uint8_t>> bytes = encode_png(picture);
  if (!bytes) return Error{fmt::format("writing {}: {}", path, bytes.error())};
  Result<AtomicFile> file = AtomicFile::create(path);
  if (!file) return Error{file.error()};
  file->write(bytes->data(), bytes->size());
  return file->commit();
}

}  // namespace kerf
