#include "viewer/raycast/tool_rays.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <limits>
#include <utility>

namespace kerf {
namespace {

/// Segments of the outline that meet at a smaller angle share their normal (20 degrees).
constexpr float kSmoothCosine = 0.94f;
/// Of squared radii, for rounding: rays that pass farther from the axis are not looked at.
constexpr double kSlack = 1.0 + 1e-9;
constexpr double kRound_mm = 1e-6;

/// The two solutions of a t^2 + 2 b t + c = 0, ascending; one may be infinite. None: no solution.
std::optional<std::array<double, 2>> roots(double a, double b, double c) {
  const double root2 = b * b - a * c;
  if (root2 < 0) return std::nullopt;
  const double q = -(b + std::copysign(std::sqrt(root2), b));
  if (q == 0) return a == 0 ? std::nullopt : std::optional(std::array{0.0, 0.0});
  const double one = c / q, two = q / a;
  return std::array{std::min(one, two), std::max(one, two)};
}

}  // namespace

ToolRays::ToolRays(const ToolShape& shape, const ToolPose& pose) : tip_mm_(pose.tip_mm) {
  z_ = glm::normalize(pose.axis);
  // Any direction across the axis will do: the tool is round.
  y_ = glm::normalize(glm::cross(z_, std::abs(z_.x) < 0.9 ? Vec3(1, 0, 0) : Vec3(0, 1, 0)));
  x_ = glm::cross(y_, z_);
  add(shape.cutter, ToolPart::kCutter);
  add(shape.shank, ToolPart::kShank);
  add(shape.holder, ToolPart::kHolder);
}

void ToolRays::add(std::span<const ProfilePoint> outline, ToolPart part) {
  if (outline.size() < 2) return;
  std::vector<ProfilePoint> points;
  points.push_back({0.0f, outline.front().height_mm});
  points.insert(points.end(), outline.begin(), outline.end());
  points.push_back({0.0f, outline.back().height_mm});
  points.erase(std::unique(points.begin(), points.end()), points.end());
  std::vector<glm::vec2> normals;
  for (std::size_t n = 0; n + 1 < points.size(); ++n) {
    const glm::vec2 along(points[n + 1].radius_mm - points[n].radius_mm,
                          points[n + 1].height_mm - points[n].height_mm);
    normals.push_back(glm::normalize(glm::vec2(along.y, -along.x)));
  }
  const auto smooth = [&](std::size_t n, std::size_t other) {
    if (glm::dot(normals[n], normals[other]) < kSmoothCosine) return normals[n];
    return glm::normalize(normals[n] + normals[other]);
  };
  for (std::size_t n = 0; n < normals.size(); ++n) {
    const auto [r0, z0] = std::pair<double, double>(points[n].radius_mm, points[n].height_mm);
    const auto [r1, z1] =
        std::pair<double, double>(points[n + 1].radius_mm, points[n + 1].height_mm);
    segments_.push_back({r0, z0, r1, z1, smooth(n, n == 0 ? n : n - 1),
                         smooth(n, std::min(n + 1, normals.size() - 1)), part});
    const double r = std::max(r0, r1);
    radius_mm_ = std::max(radius_mm_, r);
    Box box;
    for (const double z : {z0, z1}) {
      const Vec3 middle = tip_mm_ + z * z_;
      const Vec3 reach(r * std::hypot(x_.x, y_.x), r * std::hypot(x_.y, y_.y),
                       r * std::hypot(x_.z, y_.z));
      box.extend(middle - reach);
      box.extend(middle + reach);
    }
    boxes_mm_.push_back(box);
  }
}

std::optional<ToolHit> ToolRays::trace(const Ray& ray, double before_t) const {
  if (segments_.empty()) return std::nullopt;
  const Vec3 from = ray.origin_mm - tip_mm_;
  const Vec3 o(glm::dot(from, x_), glm::dot(from, y_), glm::dot(from, z_));
  const Vec3 d(glm::dot(ray.direction_mm, x_), glm::dot(ray.direction_mm, y_),
               glm::dot(ray.direction_mm, z_));
  const double dd = d.x * d.x + d.y * d.y, od = o.x * d.x + o.y * d.y;
  const double oo = o.x * o.x + o.y * o.y;
  if (dd * (oo - radius_mm_ * radius_mm_ * kSlack) > od * od) return std::nullopt;
  double best = before_t;
  const Segment* met = nullptr;
  double met_share = 0;
  const auto offer = [&](const Segment& s, double t, double share) {
    // Ends belong to both of their segments: rays must not slip through between them.
    constexpr double kRound = 1e-9;
    if (!(t > ray.t_min && t < best && share >= -kRound && share <= 1 + kRound)) return;
    best = t;
    met = &s;
    met_share = std::clamp(share, 0.0, 1.0);
  };
  const double nearest2 = dd > 0 ? oo - od * od / dd : oo;  // to the axis, squared
  // Heights at which the ray is near enough to the axis for any segment.
  double low = -std::numeric_limits<double>::infinity(), high = -low;
  if (dd > 0) {
    const double reach2 = radius_mm_ * radius_mm_ * kSlack;
    const double half = std::sqrt(std::max(0.0, od * od - dd * (oo - reach2))) / dd;
    const double middle = o.z - od / dd * d.z, aside = std::abs(half * d.z) + kRound_mm;
    low = middle - aside;
    high = middle + aside;
  }
  for (const Segment& s : segments_) {
    if (std::max(s.z0, s.z1) < low || std::min(s.z0, s.z1) > high) continue;
    const double widest = std::max(s.r0, s.r1);
    if (nearest2 > widest * widest * kSlack) continue;
    if (s.z0 == s.z1) {
      if (d.z == 0) continue;
      const double t = (s.z0 - o.z) / d.z;
      const double x = o.x + t * d.x, y = o.y + t * d.y;
      const double r = std::sqrt(x * x + y * y);
      offer(s, t, (r - s.r0) / (s.r1 - s.r0));
      continue;
    }
    // Radius r0 + slope (z - z0), squared, against that of the ray.
    const double slope = (s.r1 - s.r0) / (s.z1 - s.z0);
    const double at = s.r0 + slope * (o.z - s.z0), per_t = slope * d.z;
    const auto found = roots(dd - per_t * per_t, od - at * per_t, oo - at * at);
    if (!found) continue;
    for (const double t : *found) offer(s, t, (o.z + t * d.z - s.z0) / (s.z1 - s.z0));
  }
  if (met == nullptr) return std::nullopt;
  const Vec3 p = o + best * d;
  const double r = std::sqrt(p.x * p.x + p.y * p.y);
  const glm::vec2 n =
      glm::normalize(glm::mix(met->normal0, met->normal1, static_cast<float>(met_share)));
  const Vec3 out = r > 0 ? Vec3(p.x / r, p.y / r, 0) : Vec3(0);
  const Vec3 normal =
      static_cast<double>(n.x) * (out.x * x_ + out.y * y_) + static_cast<double>(n.y) * z_;
  return ToolHit{best, met->part, glm::normalize(glm::vec3(normal))};
}

}  // namespace kerf
