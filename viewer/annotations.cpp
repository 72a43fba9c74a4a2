#include "viewer/annotations.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <string>

namespace kerf {
namespace {

constexpr glm::vec2 kReference_px{1600.0f, 1200.0f};
/// Letters do not shrink below this, however small the picture.
constexpr float kMinCapHeight_px = 9.0f;
constexpr float kCapHeight_px = 16.5f;
constexpr float kCaptionMargin_px = 32.0f;
/// Shares of the longest side of the scene.
constexpr double kDimensionOffset = 0.055;
constexpr double kAxisLength = 0.2;
/// The axes are drawn at the origin if it lies within the scene enlarged by this share, else in a
/// corner.
constexpr double kOriginReach = 0.3;

constexpr glm::vec4 kInk{0.16f, 0.19f, 0.23f, 1.0f};
constexpr glm::vec4 kThinInk{0.30f, 0.35f, 0.41f, 1.0f};
constexpr glm::vec4 kOutline{0.27f, 0.37f, 0.52f, 0.75f};
constexpr glm::vec4 kOutlineBehind{0.27f, 0.37f, 0.52f, 0.32f};
constexpr glm::vec4 kHalo{0.97f, 0.975f, 0.98f, 0.85f};
constexpr std::array<glm::vec4, 3> kAxisColors = {glm::vec4(0.80f, 0.13f, 0.11f, 1.0f),
                                                  glm::vec4(0.08f, 0.52f, 0.16f, 1.0f),
                                                  glm::vec4(0.10f, 0.28f, 0.80f, 1.0f)};
constexpr std::array<const char*, 3> kAxisNames = {"X", "Y", "Z"};

Vec3 axis_vector(int axis) {
  Vec3 v(0.0);
  v[axis] = 1.0;
  return v;
}

/// 1, 2 or 5 times a power of ten, at least `least`.
double round_step(double least) {
  const double decade = std::pow(10.0, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * decade >= least * (1.0 - 1e-9)) return factor * decade;
  }
  return 10.0 * decade;
}

/// "100", "12.5", "0.125": at most three decimals.
std::string millimetres(double value_mm) {
  return fmt::format("{}", std::round(value_mm * 1000.0) / 1000.0);
}

Stroke stroke_between(const glm::vec3& from, const glm::vec3& to, float width_px,
                      const glm::vec4& rgba, float hidden_alpha) {
  return {glm::vec2(from), glm::vec2(to), from.z, to.z, width_px, rgba, hidden_alpha};
}

glm::vec2 unit_or(const glm::vec2& v, const glm::vec2& otherwise) {
  const float length = glm::length(v);
  return length > 1e-3f ? v / length : otherwise;
}

}  // namespace

Annotations::Annotations(const Box& blank_mm, const Box& part_mm, const Vec3& direction,
                         glm::ivec2 picture_px, Standing standing)
    : blank_mm_(blank_mm),
      scene_mm_(part_mm),
      picture_px_(picture_px),
      direction_(direction),
      standing_(standing) {
  scene_mm_.extend(blank_mm);
  unit_px_ = std::min(picture_px_.x / kReference_px.x, picture_px_.y / kReference_px.y);
  cap_height_px_ = std::max(kMinCapHeight_px, kCapHeight_px * unit_px_);
  const Vec3 size = scene_mm_.size();
  const double longest_mm = std::max({size.x, size.y, size.z});
  axis_length_mm_ = kAxisLength * longest_mm;
  origin_is_near_ = true;
  for (int axis = 0; axis < 3; ++axis) {
    const double reach = kOriginReach * longest_mm;
    origin_is_near_ =
        origin_is_near_ && scene_mm_.min[axis] - reach <= 0.0 && scene_mm_.max[axis] + reach >= 0.0;
  }
  if (blank_mm_.empty()) return;
  const double offset_mm = kDimensionOffset * longest_mm;
  const Vec3 right = glm::normalize(glm::cross(up_of(standing_), direction_));
  dimensions_ = standing_ == Standing::kOnTable ? box_dimensions(right, offset_mm)
                                                : turned_dimensions(offset_mm);
}

std::vector<Annotations::Dimension> Annotations::box_dimensions(const Vec3& right,
                                                                double offset_mm) const {
  const Vec3& low = blank_mm_.min;
  const Vec3& high = blank_mm_.max;
  return {{"X", Side::kBelow, low, {high.x, low.y, low.z}, {0, -offset_mm, 0}},
          {"Y", Side::kRight, {high.x, low.y, low.z}, {high.x, high.y, low.z}, {offset_mm, 0, 0}},
          {"Z", Side::kLeft, low, {low.x, low.y, high.z}, -offset_mm * right}};
}

/// On the side of the eye, where the part does not hide them: length below, diameter beside the
/// chuck's end.
std::vector<Annotations::Dimension> Annotations::turned_dimensions(double offset_mm) const {
  const Vec3 low_z(0, 0, blank_mm_.min.z), high_z(0, 0, blank_mm_.max.z);
  const Vec3 up = up_of(standing_);
  const double radius_mm = 0.5 * glm::dot(blank_mm_.size(), up);
  const Vec3 across = radius_mm * up;
  const Vec3 before = radius_mm * in_workpiece({0, -1, 0}, standing_);
  return {{"Z", Side::kBelow, low_z - across + before, high_z - across + before, -offset_mm * up},
          {"\u00d8",
           Side::kLeft,
           low_z - across + before,
           low_z + across + before,
           {0, 0, -offset_mm}}};
}

std::vector<Vec3> Annotations::points_to_fit() const {
  std::vector<Vec3> points;
  for (unsigned corner = 0; corner < 8; ++corner) {
    points.push_back({(corner & 1u) ? scene_mm_.max.x : scene_mm_.min.x,
                      (corner & 2u) ? scene_mm_.max.y : scene_mm_.min.y,
                      (corner & 4u) ? scene_mm_.max.z : scene_mm_.min.z});
  }
  for (const Dimension& d : dimensions_) {
    points.push_back(d.from_mm + d.offset_mm);
    points.push_back(d.to_mm + d.offset_mm);
  }
  if (origin_is_near_) {
    points.push_back(Vec3(0.0));
    for (int axis = 0; axis < 3; ++axis) points.push_back(axis_length_mm_ * axis_vector(axis));
  }
  return points;
}

std::string Annotations::label_of(const Dimension& dimension) {
  return fmt::format("{} {} mm", dimension.name,
                     millimetres(glm::length(dimension.to_mm - dimension.from_mm)));
}

Margins Annotations::margins() const {
  Margins margins{60.0f * unit_px_, 60.0f * unit_px_, 60.0f * unit_px_,
                  kCaptionMargin_px * unit_px_ + 1.5f * cap_height_px_};
  for (const Dimension& d : dimensions_) {
    const float room_px = label_width_px(label_of(d), cap_height_px_) + 3.0f * cap_height_px_;
    if (d.side == Side::kBelow) margins.bottom_px += 2.2f * cap_height_px_;
    if (d.side == Side::kRight) margins.right_px = std::max(margins.right_px, room_px);
    if (d.side == Side::kLeft) margins.left_px = std::max(margins.left_px, room_px);
  }
  // However narrow the picture, most of it is for the part.
  margins.left_px = std::min(margins.left_px, 0.3f * picture_px_.x);
  margins.right_px = std::min(margins.right_px, 0.3f * picture_px_.x);
  margins.bottom_px = std::min(margins.bottom_px, 0.3f * picture_px_.y);
  return margins;
}

std::vector<Stroke> Annotations::layout(const Camera& camera, std::string_view caption) const {
  std::vector<Stroke> strokes;
  if (!blank_mm_.empty()) add_outline(camera, &strokes);
  for (const Dimension& d : dimensions_) add_dimension(d, camera, &strokes);
  add_axes(camera, &strokes);
  add_caption(caption, &strokes);
  return strokes;
}

void Annotations::add_outline(const Camera& camera, std::vector<Stroke>* strokes) const {
  for (const LineSegment& line : outline_) {
    strokes->push_back(stroke_between(camera.project(Vec3(line.from_mm)),
                                      camera.project(Vec3(line.to_mm)), 1.5f * unit_px_, kOutline,
                                      0.0f));
  }
  if (!outline_.empty()) return;
  const auto corner = [&](unsigned bits) {
    return camera.project({(bits & 1u) ? blank_mm_.max.x : blank_mm_.min.x,
                           (bits & 2u) ? blank_mm_.max.y : blank_mm_.min.y,
                           (bits & 4u) ? blank_mm_.max.z : blank_mm_.min.z});
  };
  // The corner farthest from the eye: its three edges would be out of sight if the blank were
  // solid.
  const unsigned far_corner =
      (direction_.x > 0 ? 0u : 1u) | (direction_.y > 0 ? 0u : 2u) | (direction_.z > 0 ? 0u : 4u);
  for (unsigned from = 0; from < 8; ++from) {
    for (const unsigned bit : {1u, 2u, 4u}) {
      const unsigned to = from | bit;
      if (to == from) continue;
      const bool behind = from == far_corner || to == far_corner;
      strokes->push_back(stroke_between(corner(from), corner(to), 1.5f * unit_px_,
                                        behind ? kOutlineBehind : kOutline, 0.0f));
    }
  }
}

void Annotations::add_dimension(const Dimension& dimension, const Camera& camera,
                                std::vector<Stroke>* strokes) const {
  const auto at = [&](double along, double away) {
    return camera.project(dimension.from_mm + along * (dimension.to_mm - dimension.from_mm) +
                          away * dimension.offset_mm);
  };
  const auto line = [&](const glm::vec3& from, const glm::vec3& to, float width_px) {
    strokes->push_back(stroke_between(from, to, width_px * unit_px_, kThinInk, 0.10f));
  };
  line(at(0, 1), at(1, 1), 1.4f);
  line(at(0, 0.15), at(0, 1.25), 1.2f);
  line(at(1, 0.15), at(1, 1.25), 1.2f);

  // Ruler division: it shows the scale along the edge, which shrinks with the distance.
  const double length_mm = glm::length(dimension.to_mm - dimension.from_mm);
  const float length_px = glm::length(glm::vec2(at(1, 1)) - glm::vec2(at(0, 1)));
  if (length_mm > 0.0 && length_px > 0.0f) {
    const double px_per_mm = static_cast<double>(length_px) / length_mm;
    const double step_mm = round_step(9.0 * static_cast<double>(unit_px_) / px_per_mm);
    const double decade_mm = std::pow(10.0, std::floor(std::log10(step_mm) + 1e-9) + 1.0);
    const int per_long = static_cast<int>(std::lround(decade_mm / step_mm));
    for (int i = 1; i * step_mm < length_mm; ++i) {
      const double along = i * step_mm / length_mm;
      line(at(along, 1), at(along, i % per_long == 0 ? 0.66 : 0.84), 1.1f);
    }
  }
  const glm::vec2 middle(at(0.5, 1.25));
  const glm::vec2 outward = unit_or(middle - glm::vec2(at(0.5, 0)), {0.0f, 1.0f});
  LabelStyle style;
  style.cap_height_px = cap_height_px_;
  style.rgba = kInk;
  style.halo_rgba = kHalo;
  // The side of the text that faces the line touches it, at a distance.
  const glm::vec2 anchor(0.5f - 0.5f * std::clamp(1.6f * outward.x, -1.0f, 1.0f),
                         0.5f + 0.5f * std::clamp(1.6f * outward.y, -1.0f, 1.0f));
  add_label(label_of(dimension), middle + outward * (0.7f * style.cap_height_px), anchor, style,
            strokes);
}

void Annotations::add_axes(const Camera& camera, std::vector<Stroke>* strokes) const {
  const glm::vec2 corner_px = picture_px_ + glm::vec2(-90.0f, -80.0f) * unit_px_;
  const glm::vec3 origin = origin_is_near_ ? camera.project(Vec3(0.0)) : glm::vec3(corner_px, -1);
  for (std::size_t i = 0; i < 3; ++i) {
    const int axis = static_cast<int>(i);
    const glm::vec4& rgba = kAxisColors[i];
    glm::vec3 tip;
    if (origin_is_near_) {
      tip = camera.project(axis_length_mm_ * axis_vector(axis));
    } else {
      const glm::vec3 in_view(camera.view_from_world()[axis]);
      tip = origin + 60.0f * unit_px_ * glm::vec3(in_view.x, -in_view.y, 0.0f);
    }
    const glm::vec2 along = unit_or(glm::vec2(tip - origin), {0.0f, -1.0f});
    const glm::vec2 across(-along.y, along.x);
    strokes->push_back(stroke_between(origin, tip, 3.2f * unit_px_, rgba, 0.30f));
    for (const float side : {-1.0f, 1.0f}) {
      const glm::vec2 barb = glm::vec2(tip) + (-13.0f * along + side * 5.5f * across) * unit_px_;
      strokes->push_back(stroke_between(tip, glm::vec3(barb, tip.z), 3.2f * unit_px_, rgba, 0.30f));
    }
    LabelStyle style;
    style.cap_height_px = cap_height_px_;
    style.rgba = rgba;
    style.halo_rgba = kHalo;
    add_label(kAxisNames[i], glm::vec2(tip) + along * (1.1f * style.cap_height_px), {0.5f, 0.5f},
              style, strokes);
  }
  strokes->push_back(stroke_between(origin, origin, 8.0f * unit_px_, kInk, 0.30f));
}

void Annotations::add_caption(std::string_view caption, std::vector<Stroke>* strokes) const {
  if (caption.empty()) return;
  const float margin_px = kCaptionMargin_px * unit_px_;
  LabelStyle style;
  style.cap_height_px = cap_height_px_;
  const float width_px = label_width_px(caption, style.cap_height_px);
  // A long caption gets smaller rather than being cut off.
  const float room_px =
      picture_px_.x - 2.0f * margin_px - (origin_is_near_ ? 0.0f : 160.0f * unit_px_);
  if (width_px > room_px) style.cap_height_px *= room_px / width_px;
  style.rgba = kInk;
  add_label(caption, {margin_px, picture_px_.y - margin_px}, {0.0f, 0.0f}, style, strokes);
}

}  // namespace kerf
