#include "viewer/raycast/height_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "base/translate.h"
#include "viewer/annotations.h"
#include "viewer/camera.h"
#include "viewer/raycast/height_surface.h"
#include "viewer/raycast/parallel.h"
#include "viewer/raycast/part_light.h"
#include "viewer/raycast/scene_light.h"
#include "viewer/raycast/stroke_raster.h"

namespace kerf {
namespace {

// As picture.cpp, part_renderer.cpp and their shaders have them.
constexpr int kMinSize_px = 64;
constexpr int kMaxSize_px = 8192;
constexpr double kFieldOfView_deg = 24.0;
constexpr Vec3 kEyeDirection{0.60, -1.0, 0.86};
constexpr float kReferenceHeight_px = 1200.0f;
constexpr float kEdgeStrength = 0.70f;
constexpr float kSmallestEdgeStrength = 0.45f;
constexpr float kEdgeBegin = 0.16f, kEdgeFull = 0.47f, kJumpBegin_px = 4.0f;
constexpr float kOcclusionReach = 0.05f;
constexpr int kTaps = 10;
constexpr float kTapBias = 0.06f, kOcclusionStrength = 3.2f;
/// Pixels whose normals are those of their neighbours need one ray.
constexpr float kOneRay = 0.999999f;
/// Where they differ by no more than that (8 degrees), and lie no farther off the plane through
/// those on both sides, nothing hides between them: it is the plane, but for its normals, if it is
/// not seen too flatly.
constexpr float kEvenNormals = 0.99f, kEven_px = 0.5f, kLeastFacing = 0.2f;

Box material_box(const HeightGrid& grid) {
  Box box;
  const Vec3& corner = grid.bounds_mm().min;
  for (int j = 0; j < grid.ny(); ++j) {
    for (int i = 0; i < grid.nx(); ++i) {
      const float z = grid.height(i, j);
      if (!(z > grid.floor_mm())) continue;
      box.extend(Vec3(corner.x + i * grid.cell_x_mm(), corner.y + j * grid.cell_y_mm(), corner.z));
      box.extend(Vec3(corner.x + (i + 1) * grid.cell_x_mm(), corner.y + (j + 1) * grid.cell_y_mm(),
                      static_cast<double>(z)));
    }
  }
  return box;
}

/// Values for each pixel of a picture, rows from the top. Beyond the rim those of the rim count.
template <class T>
class Layer {
 public:
  Layer(glm::ivec2 size, const T& value)
      : size_(size),
        values_(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y), value) {}
  T& at(int x, int y) { return values_[index(x, y)]; }
  const T& near(int x, int y) const {
    return values_[index(std::clamp(x, 0, size_.x - 1), std::clamp(y, 0, size_.y - 1))];
  }
  const std::vector<T>& values() const { return values_; }

 private:
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(size_.x) +
           static_cast<std::size_t>(x);
  }
  glm::ivec2 size_;
  std::vector<T> values_;
};

glm::vec3 unit(const glm::vec3& v) { return v / std::sqrt(std::max(glm::dot(v, v), 1e-6f)); }

/// The passes of PartRenderer, one row of pixels after the other.
class PartPainter {
 public:
  PartPainter(const HeightSurface& surface, const Camera& camera, glm::ivec2 size_px, int threads)
      : surface_(surface),
        camera_(camera),
        frame_(camera.clip_from_world(), size_px),
        size_px_(size_px),
        threads_(threads),
        unproject_(camera.unproject()),
        normals_(size_px, glm::vec4(0)),
        depths_(size_px, 1.0f),
        rays_(size_px, Rays::kOne),
        open_((size_px + 1) / 2, 1.0f),
        edges_(size_px, 0.0f) {}

  Picture paint() {
    rows(
        size_px_.y, [this](int x, int y) { cast_middle(x, y); }, size_px_.x);
    rows(
        size_px_.y, [this](int x, int y) { rays_.at(x, y) = rays_of(x, y); }, size_px_.x);
    rows(
        size_px_.y,
        [this](int x, int y) {
          if (rays_.near(x, y) != Rays::kOne) cast(x, y);
        },
        size_px_.x);
    rows((size_px_.y + 1) / 2, [this](int x, int y) { occlude(x, y); }, (size_px_.x + 1) / 2);
    rows(
        size_px_.y, [this](int x, int y) { find_edge(x, y); }, size_px_.x);
    Picture picture{size_px_.x, size_px_.y, {}};
    picture.rgb.resize(3 * static_cast<std::size_t>(size_px_.x) *
                       static_cast<std::size_t>(size_px_.y));
    rows(
        size_px_.y, [&](int x, int y) { compose(x, y, &picture); }, size_px_.x);
    return picture;
  }
  const std::vector<float>& depths() const { return depths_.values(); }

 private:
  /// What a pixel needs: the ray through its middle, the normals of 2 x 2 about that, or as many
  /// rays.
  enum class Rays : std::uint8_t { kOne, kNormals, kFour };

  template <class Work>
  void rows(int count, const Work& work, int width) const {
    for_each_piece(static_cast<std::size_t>(count), threads_, 2, [&](std::size_t y) {
      for (int x = 0; x < width; ++x) work(x, static_cast<int>(y));
    });
  }
  float distance_mm(float depth) const { return 1.0f / (unproject_.z + unproject_.w * depth); }
  glm::vec2 tangent(int x, int y) const {
    return glm::vec2(
               2.0f * (static_cast<float>(x) + 0.5f) / static_cast<float>(size_px_.x) - 1.0f,
               1.0f - 2.0f * (static_cast<float>(y) + 0.5f) / static_cast<float>(size_px_.y)) *
           glm::vec2(unproject_);
  }
  glm::vec3 position_view(int x, int y) const {
    const int at_x = std::clamp(x, 0, size_px_.x - 1), at_y = std::clamp(y, 0, size_px_.y - 1);
    return glm::vec3(tangent(at_x, at_y), -1.0f) * distance_mm(depths_.near(at_x, at_y));
  }

  void cast_middle(int x, int y);
  Rays rays_of(int x, int y) const;
  void cast(int x, int y);
  void occlude(int x, int y);
  void find_edge(int x, int y);
  void compose(int x, int y, Picture* picture);

  const HeightSurface& surface_;
  const Camera& camera_;
  RayFrame frame_;
  glm::ivec2 size_px_;
  int threads_;
  glm::vec4 unproject_;
  Layer<glm::vec4> normals_;  ///< mean in view space, and coverage
  Layer<float> depths_;
  Layer<Rays> rays_;
  Layer<float> open_;  ///< at half the size
  Layer<float> edges_;
};

void PartPainter::cast_middle(int x, int y) {
  const Ray ray = frame_.ray(x + 0.5, y + 0.5);
  SurfaceHit hit;
  if (!surface_.trace(ray, &hit)) return;
  normals_.at(x, y) =
      glm::vec4(glm::mat3(camera_.view_from_world()) * surface_.normal(ray, hit), 1.0f);
  depths_.at(x, y) = frame_.depth(ray, hit.t);
}

PartPainter::Rays PartPainter::rays_of(int x, int y) const {
  const glm::vec4& normal = normals_.near(x, y);
  const float at_mm = distance_mm(depths_.near(x, y));
  const float even_mm = kEven_px * camera_.px_mm_at_1mm() * at_mm;
  float least = 1;
  for (const glm::ivec2& way : {glm::ivec2(1, 0), glm::ivec2(0, 1)}) {
    const glm::vec4& a = normals_.near(x + way.x, y + way.y);
    const glm::vec4& b = normals_.near(x - way.x, y - way.y);
    if (a.w != normal.w || b.w != normal.w) return Rays::kFour;
    if (normal.w == 0) continue;
    least = std::min({least, glm::dot(glm::vec3(a), glm::vec3(normal)),
                      glm::dot(glm::vec3(b), glm::vec3(normal))});
    const float between =
        0.5f * (depths_.near(x + way.x, y + way.y) + depths_.near(x - way.x, y - way.y));
    if (least < kEvenNormals || std::abs(distance_mm(between) - at_mm) > even_mm)
      return Rays::kFour;
  }
  if (least >= kOneRay) return Rays::kOne;
  const glm::vec3 to_eye = unit(glm::vec3(-tangent(x, y), 1.0f));
  return glm::dot(glm::vec3(normal), to_eye) > kLeastFacing ? Rays::kNormals : Rays::kFour;
}

/// The mean of 2 x 2 rays; on an even surface they meet the plane through its middle.
void PartPainter::cast(int x, int y) {
  const glm::mat3 view_from_world(camera_.view_from_world());
  const bool is_even = rays_.near(x, y) == Rays::kNormals;
  const Ray middle = frame_.ray(x + 0.5, y + 0.5);
  const float at_mm = distance_mm(depths_.near(x, y));
  const Vec3 out(glm::transpose(view_from_world) * glm::vec3(normals_.near(x, y)));
  const double above =
      is_even ? glm::dot(out, static_cast<double>(at_mm) * middle.direction_mm) : 0;
  const auto within_mm = static_cast<double>(2 * kEven_px * camera_.px_mm_at_1mm() * at_mm);
  glm::vec4 normals(0);
  float depths = 0;
  for (unsigned sample = 0; sample < 4; ++sample) {
    const Ray ray =
        frame_.ray(x + ((sample & 1u) ? 0.75 : 0.25), y + ((sample & 2u) ? 0.75 : 0.25));
    if (is_even) {
      const double t = above / glm::dot(out, ray.direction_mm);
      if (const std::optional<glm::vec3> normal = surface_.normal_beside(ray, t, within_mm)) {
        normals += glm::vec4(view_from_world * *normal, 1.0f);
        depths += depths_.near(x, y);
        continue;
      }
    }
    SurfaceHit hit;
    if (!surface_.trace(ray, &hit)) continue;
    normals += glm::vec4(view_from_world * surface_.normal(ray, hit), 1.0f);
    depths += frame_.depth(ray, hit.t);
  }
  depths_.at(x, y) = normals.w > 0 ? depths / normals.w : 1.0f;
  normals_.at(x, y) = 0.25f * normals;
}

/// Scalable ambient obscurance (McGuire, Mara, Luebke, HPG 2012), few taps, turned by a pattern of
/// 4 x 4 that compose() averages away.
void PartPainter::occlude(int x, int y) {
  const int px = std::min(2 * x, size_px_.x - 1), py = std::min(2 * y, size_px_.y - 1);
  const glm::vec4 normal = normals_.near(px, py);
  if (normal.w == 0) return;
  const glm::vec3 n = unit(glm::vec3(normal));
  const glm::vec3 p = position_view(px, py);
  const float radius_mm = kOcclusionReach * camera_.distance_mm();
  const float radius_px = radius_mm / camera_.px_mm_at_1mm() / -p.z;
  const int cell_x = x & 3, cell_y = y & 3;
  const int scrambled = (cell_x * 4 + cell_y * 7 + (cell_x ^ cell_y) * 9) & 15;
  const float turn = static_cast<float>(scrambled) * (6.2831853f / 16.0f);
  float sum = 0;
  for (int i = 0; i < kTaps; ++i) {
    const float along = (static_cast<float>(i) + 0.5f) / static_cast<float>(kTaps);
    const float angle = static_cast<float>(i) * 2.3999632f + turn;  // golden angle
    const float reach = along * radius_px;
    const glm::vec3 v =
        position_view(px + static_cast<int>(std::floor(reach * std::cos(angle) + 0.5f)),
                      py - static_cast<int>(std::floor(reach * std::sin(angle) + 0.5f))) -
        p;
    const float vv = glm::dot(v, v);
    const float falloff = std::max(0.0f, 1.0f - vv / (radius_mm * radius_mm));
    sum += falloff * std::max(0.0f, glm::dot(v, n) / std::sqrt(vv + 1e-6f) - kTapBias);
  }
  open_.at(x, y) = std::max(0.0f, 1.0f - kOcclusionStrength * sum / static_cast<float>(kTaps));
}

/// Sharp edges and silhouettes: 0 where the surface is smooth, 1 on an edge.
void PartPainter::find_edge(int x, int y) {
  const float depth = depths_.near(x, y);
  if (normals_.near(x, y).w == 0) return;
  const int reach = std::max(
      1, static_cast<int>(std::round(static_cast<float>(size_px_.y) / kReferenceHeight_px)));
  const float at_mm = distance_mm(depth);
  const float begin_mm = kJumpBegin_px * camera_.px_mm_at_1mm() * at_mm;
  float crease = 0, deepest = depth;
  constexpr std::array<glm::ivec2, 4> kWays{{glm::ivec2(1, 0), {0, 1}, {1, 1}, {1, -1}}};
  for (const glm::ivec2& way : kWays) {
    const int dx = reach * way.x, dy = reach * way.y;
    const glm::vec4 a = normals_.near(x + dx, y + dy), b = normals_.near(x - dx, y - dy);
    if (std::min(a.w, b.w) >= 0.5f)
      crease = std::max(crease, 1.0f - glm::dot(unit(glm::vec3(a)), unit(glm::vec3(b))));
    // Depth is affine in the picture on a plane, so the mean of two opposite pixels equals it
    // there. Signed: only the nearer side of a jump is drawn.
    deepest =
        std::max(deepest, 0.5f * (depths_.near(x + dx, y + dy) + depths_.near(x - dx, y - dy)));
  }
  const float jump_mm = distance_mm(deepest) - at_mm;
  edges_.at(x, y) = std::max(part_light::smooth_step(kEdgeBegin, kEdgeFull, crease),
                             part_light::smooth_step(begin_mm, 2.0f * begin_mm, jump_mm));
}

void PartPainter::compose(int x, int y, Picture* picture) {
  const float v = 1.0f - (static_cast<float>(y) + 0.5f) / static_cast<float>(size_px_.y);
  glm::vec3 color = scene_light::background(v);
  const glm::vec4 normal = normals_.near(x, y);
  if (normal.w > 0) {
    float open = 0, edge = 0;
    const int corner_x = (x + 1) / 2, corner_y = (y + 1) / 2;
    for (int dy = -2; dy < 2; ++dy)
      for (int dx = -2; dx < 2; ++dx) open += open_.near(corner_x + dx, corner_y + dy) / 16.0f;
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx)
        edge +=
            edges_.near(x + dx, y + dy) * static_cast<float>((2 - dx * dx) * (2 - dy * dy)) / 16.0f;
    const glm::vec2 aside = -tangent(x, y);
    const glm::vec3 up(camera_.view_from_world()[2]);
    const glm::vec3 linear =
        part_light::lit(unit(glm::vec3(normal)), unit(glm::vec3(aside, 1.0f)),
                        unit(glm::vec3(part_light::kNearRoom * aside, 1.0f)), up, open);
    const float strength =
        std::clamp(kEdgeStrength * static_cast<float>(size_px_.y) / kReferenceHeight_px,
                   kSmallestEdgeStrength, kEdgeStrength);
    for (int k = 0; k < 3; ++k) {
      const float surface = std::sqrt(std::clamp(linear[k], 0.0f, 1.0f)) * (1.0f - strength * edge);
      color[k] += normal.w * (surface - color[k]);
    }
  }
  const auto at = 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(size_px_.x) +
                       static_cast<std::size_t>(x));
  for (int k = 0; k < 3; ++k)
    picture->rgb[at + static_cast<std::size_t>(k)] =
        static_cast<std::uint8_t>(std::clamp(color[k], 0.0f, 1.0f) * 255.0f + 0.5f);
}

}  // namespace

Result<Picture> draw_heights(std::shared_ptr<const HeightGrid> grid, const PictureOptions& options,
                             int threads) {
  const glm::ivec2 size_px(options.width_px, options.height_px);
  if (std::min(size_px.x, size_px.y) < kMinSize_px ||
      std::max(size_px.x, size_px.y) > kMaxSize_px) {
    return Error{trf("a picture of {} x {} pixels is not allowed; each side must be {} to {}",
                     size_px.x, size_px.y, kMinSize_px, kMaxSize_px)};
  }
  const Box part_mm = material_box(*grid);
  if (part_mm.empty() && options.blank_mm.empty()) {
    return Error{tr("nothing to draw: the part is empty and no blank is given")};
  }
  const Annotations annotations(options.blank_mm, part_mm, kEyeDirection, size_px);
  const std::vector<Vec3> points_mm = annotations.points_to_fit();
  const Camera camera =
      Camera::fit(points_mm, kEyeDirection, kFieldOfView_deg, size_px, annotations.margins());
  HeightSurface surface;
  surface.update(std::move(grid), threads);
  PartPainter painter(surface, camera, size_px, threads);
  Picture picture = painter.paint();
  draw_strokes(annotations.layout(camera, options.caption), painter.depths(), &picture);
  return picture;
}

}  // namespace kerf
