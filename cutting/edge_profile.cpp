#include "cutting/edge_profile.h"

#include <algorithm>
#include <cmath>

namespace kerf {
namespace {

/// What is lower than that is level.
constexpr double kLevel_mm = 1e-9;

}  // namespace

EdgeProfile::EdgeProfile(std::span<const Vec2> outline, double mc) : mc_(mc) {
  if (outline.empty()) return;
  radius_mm_ = outline.back().x;
  // The side may be a piece of the outline, as high as the flutes.
  std::size_t last = outline.size() - 1;
  while (last > 0 && outline[last - 1].x >= radius_mm_) --last;
  side_from_mm_ = outline[last].y - outline.front().y;
  const double tip_mm = outline.front().y;
  Row row;
  std::size_t piece = 0;
  double at_mm = 0;
  // A ball is flat at its tip, where rows over the height itself would be far apart.
  for (int k = 1; k <= kSteps && side_from_mm_ > kLevel_mm; ++k) {
    const double part = static_cast<double>(k) / kSteps;
    const double to_mm = k == kSteps ? side_from_mm_ : side_from_mm_ * part * part;
    while (at_mm < to_mm && piece + 1 <= last) {
      const Vec2 from = outline[piece], to = outline[piece + 1];
      const double rise = to.y - from.y;
      if (rise <= kLevel_mm || to.y - tip_mm <= at_mm) {
        ++piece;
        continue;
      }
      const double end_mm = std::min(to_mm, to.y - tip_mm), high = end_mm - at_mm;
      const double steep = rise / std::hypot(rise, to.x - from.x);
      const double middle = (0.5 * (at_mm + end_mm) + tip_mm - from.y) / rise;
      const double push = high * std::pow(steep, -mc);
      row.sum.push_mm += push;
      row.sum.inward_mm += push * steep;
      const double radius = from.x + (to.x - from.x) * middle;
      row.sum.turn_mm2 += push * radius;
      row.sum.half_mm2 += high * radius;
      row.sum.length_mm += high / steep;
      row.steepest = std::max(row.steepest, steep);
      row.radius_mm = from.x + (to.x - from.x) * (end_mm + tip_mm - from.y) / rise;
      at_mm = end_mm;
    }
    rows_[static_cast<std::size_t>(k)] = row;
  }
  if (side_from_mm_ > kLevel_mm) {
    rows_[0] = {};
    rows_[0].steepest = rows_[1].steepest;
    // The bottom may be level for a while.
    for (std::size_t n = 0; n + 1 < outline.size() && outline[n + 1].y - tip_mm <= kLevel_mm; ++n)
      rows_[0].radius_mm = outline[n + 1].x;
  } else {
    side_from_mm_ = 0;
  }
}

EdgeProfile EdgeProfile::cylinder(double radius_mm, double mc) {
  const std::array<Vec2, 2> outline{Vec2(0, 0), Vec2(radius_mm, 0)};
  return EdgeProfile(outline, mc);
}

EdgeProfile::Row EdgeProfile::row_at(double height_mm) const {
  const double scaled = kSteps * std::sqrt(std::clamp(height_mm / side_from_mm_, 0.0, 1.0));
  const auto k = static_cast<std::size_t>(std::min(scaled, kSteps - 1.0));
  // Between two rows the edge is taken to be straight.
  const auto height_of = [this](std::size_t row) {
    const double share = static_cast<double>(row) / kSteps;
    return side_from_mm_ * share * share;
  };
  const double below_mm = height_of(k), high_mm = height_of(k + 1) - below_mm;
  const double part = std::clamp((height_mm - below_mm) / high_mm, 0.0, 1.0);
  const Row &low = rows_[k], &high = rows_[k + 1];
  const auto between = [part](double a, double b) { return a + part * (b - a); };
  Row row;
  row.sum = {
      between(low.sum.push_mm, high.sum.push_mm), between(low.sum.inward_mm, high.sum.inward_mm),
      between(low.sum.turn_mm2, high.sum.turn_mm2), between(low.sum.length_mm, high.sum.length_mm),
      between(low.sum.half_mm2, high.sum.half_mm2)};
  row.radius_mm = between(low.radius_mm, high.radius_mm);
  row.steepest = between(low.steepest, high.steepest);
  return row;
}

EdgeProfile::Sum EdgeProfile::sum_to(double height_mm) const {
  Sum sum;
  if (side_from_mm_ > 0) sum = row_at(height_mm).sum;
  if (height_mm <= side_from_mm_) return sum;
  const double side_mm = height_mm - side_from_mm_;
  sum.push_mm += side_mm;
  sum.inward_mm += side_mm;
  sum.turn_mm2 += side_mm * radius_mm_;
  sum.length_mm += side_mm;
  sum.half_mm2 += side_mm * radius_mm_;
  return sum;
}

double EdgeProfile::radius_to(double height_mm) const {
  return height_mm >= side_from_mm_ ? radius_mm_ : row_at(height_mm).radius_mm;
}

double EdgeProfile::steepest_to(double height_mm) const {
  return height_mm > side_from_mm_ ? 1 : row_at(height_mm).steepest;
}

}  // namespace kerf
