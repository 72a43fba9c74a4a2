#include "viewer/raycast/ray_caster.h"

#include <algorithm>
#include <cmath>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <utility>

#include "viewer/raycast/parallel.h"
#include "viewer/raycast/scene_light.h"
#include "viewer/raycast/tool_rays.h"

namespace kerf {
namespace {

/// Edge of the squares of pixels that are cast together.
constexpr int kSquare_px = 8;
/// Around what a box projects to: rounding.
constexpr double kBorder_px = 1.0;
constexpr std::size_t kLeastSquaresForTwo = 16;

void put(Picture* picture, std::size_t pixel, const glm::vec3& color) {
  for (int k = 0; k < 3; ++k) {
    picture->rgb[3 * pixel + static_cast<std::size_t>(k)] =
        static_cast<std::uint8_t>(std::clamp(color[k], 0.0f, 1.0f) * 255.0f + 0.5f);
  }
}

}  // namespace

struct RayCaster::Light {
  explicit Light(const Projection& projection)
      : frame(projection.clip_from_world, projection.size_px),
        view_from_world(projection.view_from_world),
        up_view(view_from_world[2]),
        size_px(projection.size_px) {}
  glm::vec3 color(const glm::vec3& surface, const glm::vec3& normal) const {
    return scene_light::lit(surface, view_from_world * normal, up_view);
  }
  RayFrame frame;
  glm::mat3 view_from_world;
  glm::vec3 up_view;
  glm::ivec2 size_px;
};

void RayCaster::set_workpiece(std::shared_ptr<const HeightGrid> grid) {
  const std::vector<Box> changed = surface_.update(std::move(grid), threads_);
  changed_mm_.insert(changed_mm_.end(), changed.begin(), changed.end());
}

void RayCaster::set_tool_shape(std::shared_ptr<const ToolShape> shape) {
  tool_shape_ = std::move(shape);
  tool_changed_ = true;
}

void RayCaster::set_tool_pose(const std::optional<ToolPose>& pose) {
  if (pose == tool_pose_) return;
  tool_pose_ = pose;
  tool_changed_ = true;
}

void RayCaster::resize(glm::ivec2 size_px) {
  const auto pixels = static_cast<std::size_t>(size_px.x) * static_cast<std::size_t>(size_px.y);
  for (Picture* picture : {&kept_, &shown_}) {
    picture->width_px = size_px.x;
    picture->height_px = size_px.y;
    picture->rgb.assign(3 * pixels, 0);
  }
  kept_depths_.assign(pixels, 1.0f);
  shown_depths_.assign(pixels, 1.0f);
  squares_x_ = (size_px.x + kSquare_px - 1) / kSquare_px;
  squares_y_ = (size_px.y + kSquare_px - 1) / kSquare_px;
}

/// The squares that something in the box can touch; all of them if it reaches the eye's plane.
void RayCaster::mark(const Box& box_mm, Squares* squares) const {
  const glm::dmat4 clip_from_world(projection_->clip_from_world);
  const glm::dvec2 size_px(projection_->size_px);
  glm::dvec2 low(1e9), high(-1e9);
  for (unsigned corner = 0; corner < 8; ++corner) {
    const glm::dvec4 clip =
        clip_from_world * glm::dvec4((corner & 1u) ? box_mm.max.x : box_mm.min.x,
                                     (corner & 2u) ? box_mm.max.y : box_mm.min.y,
                                     (corner & 4u) ? box_mm.max.z : box_mm.min.z, 1.0);
    constexpr double kLeastW = 1e-4;
    if (!(clip.w > kLeastW)) {
      squares->assign(squares->size(), true);
      return;
    }
    const glm::dvec2 at(0.5 + 0.5 * clip.x / clip.w, 0.5 - 0.5 * clip.y / clip.w);
    low = glm::min(low, at * size_px);
    high = glm::max(high, at * size_px);
  }
  const auto square = [](double px, int count) {
    return static_cast<int>(std::clamp(std::floor(px / kSquare_px), -1.0, count + 1.0));
  };
  const int x0 = std::max(0, square(low.x - kBorder_px, squares_x_));
  const int x1 = std::min(squares_x_ - 1, square(high.x + kBorder_px, squares_x_));
  const int y0 = std::max(0, square(low.y - kBorder_px, squares_y_));
  const int y1 = std::min(squares_y_ - 1, square(high.y + kBorder_px, squares_y_));
  for (int y = y0; y <= y1; ++y)
    for (int x = x0; x <= x1; ++x) (*squares)[static_cast<std::size_t>(y * squares_x_ + x)] = true;
}

/// Calls work(x0, x1, y) for each row of pixels of the squares, on all threads; returns how many
/// pixels.
template <class Work>
std::size_t RayCaster::for_squares(const Squares& squares, const Work& work) const {
  std::vector<int> marked;
  std::size_t pixels = 0;
  const glm::ivec2 size_px = projection_->size_px;
  const auto end_of = [](int square, int size) {
    return std::min((square + 1) * kSquare_px, size);
  };
  for (std::size_t n = 0; n < squares.size(); ++n) {
    if (!squares[n]) continue;
    const int x = static_cast<int>(n) % squares_x_, y = static_cast<int>(n) / squares_x_;
    marked.push_back(static_cast<int>(n));
    pixels += static_cast<std::size_t>(end_of(x, size_px.x) - x * kSquare_px) *
              static_cast<std::size_t>(end_of(y, size_px.y) - y * kSquare_px);
  }
  for_each_piece(marked.size(), threads_, kLeastSquaresForTwo, [&](std::size_t n) {
    const int x0 = marked[n] % squares_x_, y0 = marked[n] / squares_x_;
    for (int y = y0 * kSquare_px; y < end_of(y0, size_px.y); ++y)
      work(x0 * kSquare_px, end_of(x0, size_px.x), y);
  });
  return pixels;
}

void RayCaster::cast_workpiece(const Light& light, std::size_t pixel, const Ray& ray) {
  SurfaceHit hit;
  if (surface_.trace(ray, &hit)) {
    kept_depths_[pixel] = light.frame.depth(ray, hit.t);
    put(&kept_, pixel, light.color(scene_light::kWorkpieceColor, surface_.normal(ray, hit)));
    return;
  }
  kept_depths_[pixel] = 1.0f;
  const auto row = static_cast<float>(pixel / static_cast<std::size_t>(light.size_px.x));
  put(&kept_, pixel,
      scene_light::background(1.0f - (row + 0.5f) / static_cast<float>(light.size_px.y)));
}

void RayCaster::cast_tool(const Light& light, const ToolRays& tool, std::size_t pixel,
                          const Ray& ray) {
  const std::optional<ToolHit> hit = tool.trace(ray, std::numeric_limits<double>::infinity());
  if (!hit) return;
  const float depth = light.frame.depth(ray, hit->t);
  if (!(depth < shown_depths_[pixel])) return;
  const glm::vec3 color = hit->part == ToolPart::kCutter  ? scene_light::kCutterColor
                          : hit->part == ToolPart::kShank ? scene_light::kShankColor
                                                          : scene_light::kHolderColor;
  shown_depths_[pixel] = depth;
  put(&shown_, pixel, light.color(color, hit->normal));
}

void RayCaster::find_room(const Squares& squares, RayCounters* counters) const {
  glm::ivec2 low(squares_x_, squares_y_), high(0);
  for (std::size_t n = 0; n < squares.size(); ++n) {
    if (!squares[n]) continue;
    const glm::ivec2 square(static_cast<int>(n) % squares_x_, static_cast<int>(n) / squares_x_);
    low = glm::min(low, square);
    high = glm::max(high, square + 1);
  }
  if (low.x >= high.x) return;
  counters->low_px = low * kSquare_px;
  counters->high_px = glm::min(high * kSquare_px, projection_->size_px);
}

RayCounters RayCaster::draw(const Projection& projection, bool is_local) {
  RayCounters counters;
  counters.is_full = !is_local || projection_ != projection;
  if (!projection_ || projection_->size_px != projection.size_px) resize(projection.size_px);
  projection_ = projection;
  const Light light(projection);
  const auto index_of = [&projection](int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(projection.size_px.x) +
           static_cast<std::size_t>(x);
  };
  Squares dirty(static_cast<std::size_t>(squares_x_ * squares_y_), counters.is_full);
  if (!counters.is_full)
    for (const Box& box : changed_mm_) mark(box, &dirty);
  changed_mm_.clear();
  find_room(dirty, &counters);
  counters.cast_px = for_squares(dirty, [&](int x0, int x1, int y) {
    for (int x = x0; x < x1; ++x)
      cast_workpiece(light, index_of(x, y), light.frame.ray(x + 0.5, y + 0.5));
  });

  std::optional<ToolRays> tool;
  Squares tool_squares(dirty.size(), false);
  if (tool_shape_ && tool_pose_) {
    tool.emplace(*tool_shape_, *tool_pose_);
    for (const Box& box : tool->boxes_mm()) mark(box, &tool_squares);
  }
  if (counters.is_full) tool_squares_.assign(dirty.size(), false);
  if (tool_changed_ || counters.is_full) {
    tool_squares_.resize(dirty.size());
    for (std::size_t n = 0; n < dirty.size(); ++n)
      dirty[n] = dirty[n] || tool_squares_[n] || tool_squares[n];
  }
  tool_changed_ = false;
  counters.copied_px = for_squares(dirty, [&](int x0, int x1, int y) {
    const std::size_t begin = index_of(x0, y), count = static_cast<std::size_t>(x1 - x0);
    std::copy_n(&kept_.rgb[3 * begin], 3 * count, &shown_.rgb[3 * begin]);
    std::copy_n(&kept_depths_[begin], count, &shown_depths_[begin]);
    const auto square = static_cast<std::size_t>(y / kSquare_px * squares_x_ + x0 / kSquare_px);
    if (!tool || !tool_squares[square]) return;
    for (int x = x0; x < x1; ++x)
      cast_tool(light, *tool, index_of(x, y), light.frame.ray(x + 0.5, y + 0.5));
  });
  tool_squares_ = std::move(tool_squares);
  return counters;
}

std::optional<Vec3> RayCaster::pick(glm::ivec2 px) const {
  if (!projection_ || px.x < 0 || px.y < 0 || px.x >= projection_->size_px.x ||
      px.y >= projection_->size_px.y) {
    return std::nullopt;
  }
  const RayFrame frame(projection_->clip_from_world, projection_->size_px);
  const Ray ray = frame.ray(px.x + 0.5, px.y + 0.5);
  SurfaceHit hit;
  if (!surface_.trace(ray, &hit)) return std::nullopt;
  return ray.origin_mm + hit.t * ray.direction_mm;
}

}  // namespace kerf
