#include "twin/process/milling/front_section.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "base/golden_section.h"

namespace kerf {
namespace {

constexpr double kLevelRadius_mm = 1e-3, kNoWay_mm = 1e-9;
/// Lines side by side, to begin with; where they differ they are halved up to so many times.
constexpr int kPanels = 12, kHalvings = 5;
/// Of what a panel may be off by, as part of the widest times the highest line.
constexpr double kPanelError = 2e-4;
/// Places above each other: the first is so much of a cell above the cutter, each other one as far
/// above it by so much more.
constexpr double kFirst = 0.1, kGrows = 1.2;
constexpr int kMostPlaces = 64;
constexpr int kEdgeHalvings = 9, kFrontHalvings = 18, kNarrowings = 26;
/// Rings of the disc that a plunge takes.
constexpr int kRings = 48;
/// What is asked about lies so far before the front.
constexpr double kBefore_mm = 1e-6;

}  // namespace

bool FrontSection::takes(const Cutter& cutter, const CutMove& move) {
  if (cutter.undercuts() || cutter.footprint() != nullptr || !move.is_vertical()) return false;
  if (!move.arc) return glm::length(move.to_mm - move.from_mm) > kNoWay_mm;
  const CutArc& arc = *move.arc;
  if (std::abs(arc.axis.z) < 1 - 1e-12 || arc.sweep_rad == 0) return false;
  const Vec2 from = Vec2(move.from_mm - arc.center_mm), to = Vec2(move.to_mm - arc.center_mm);
  const double radius = glm::length(from);
  return radius > kLevelRadius_mm && std::abs(glm::length(to) - radius) < kLevelRadius_mm;
}

void FrontSection::set(const Box& box, double cell_mm, const Cutter& cutter, const CutMove& move) {
  box_ = box;
  cell_ = cell_mm;
  looks_ = 0;
  radius_ = cutter.radius_mm();
  lift_.resize(kLifts + 1);
  for (int k = 0; k <= kLifts; ++k) {
    lift_[static_cast<std::size_t>(k)] = cutter.height_mm(std::min(radius_ * k / kLifts, radius_));
  }
  from_ = move.from_mm;
  const double rise = move.to_mm.z - from_.z;
  arc_ = move.arc.has_value();
  double level_mm = 0;
  if (arc_) {
    center_ = Vec2(move.arc->center_mm);
    const Vec2 arm = Vec2(from_) - center_;
    arc_radius_ = glm::length(arm);
    start_angle_ = std::atan2(arm.y, arm.x);
    turn_ = move.arc->sweep_rad * move.arc->axis.z < 0 ? -1 : 1;
    length_ = std::abs(move.arc->sweep_rad);
    level_mm = length_ * arc_radius_;
  } else {
    const Vec2 way = Vec2(move.to_mm) - Vec2(from_);
    length_ = level_mm = glm::length(way);
    if (length_ < kNoWay_mm) length_ = level_mm = 0;
    direction_ = length_ > 0 ? way / length_ : Vec2(1, 0);
  }
  way_mm_ = std::hypot(level_mm, rise);
  slope_ = length_ > 0 ? rise / length_ : rise;
  const double most = box.max.z - std::min(from_.z, move.to_mm.z);
  engaged_ = 0;
  if (most <= 0) return;
  double low = 0, high = radius_;
  if (lift(high) <= most) low = high;
  for (int i = 0; i < kFrontHalvings && low < high; ++i) {
    const double middle = 0.5 * (low + high);
    (lift(middle) <= most ? low : high) = middle;
  }
  engaged_ = low;
}

double FrontSection::lift(double radius_mm) const {
  const double scaled = std::min(radius_mm / radius_, 1.0) * kLifts;
  const auto k = std::min(static_cast<std::size_t>(scaled), static_cast<std::size_t>(kLifts - 1));
  return lift_[k] + (scaled - static_cast<double>(k)) * (lift_[k + 1] - lift_[k]);
}

/// Of a place from the tip; seen from above.
double FrontSection::distance(double beside, double along) const {
  if (!arc_) return std::hypot(beside, along);
  const double r = arc_radius_, p = r + beside;
  return std::sqrt(std::max(0.0, r * r + p * p - 2 * r * p * std::cos(along)));
}

/// Where on a line the cutter ends. False: it does not come there.
bool FrontSection::reach_of(double beside, double& reach) const {
  if (!arc_) {
    reach = std::sqrt(std::max(0.0, engaged_ * engaged_ - beside * beside));
    return reach > 0;
  }
  const double r = arc_radius_, p = r + beside;
  if (p <= 0) return false;
  const double cosine = (r * r + p * p - engaged_ * engaged_) / (2 * r * p);
  reach = std::acos(std::clamp(cosine, -1.0, 1.0));
  return reach > 0;
}

/// Where on a line that rises as the way does the cutter is lowest.
double FrontSection::lowest_along(double beside, double reach) const {
  if (slope_ == 0) return 0;
  const auto low_at = [&](double along) { return lift(distance(beside, along)) - slope_ * along; };
  const double from = slope_ < 0 ? -reach : 0, to = slope_ < 0 ? 0 : reach;
  const double found = golden_section(low_at, from, to, kNarrowings).middle();
  const double end = slope_ < 0 ? -reach : reach;
  return low_at(end) <= low_at(found) ? end : found;
}

bool FrontSection::is_solid(double beside, double along, double y) const {
  looks_ += 1;
  const double z = tip_z_ + y + slope_ * along;
  if (!arc_) {
    const Vec2 at = Vec2(from_) + (along_ + along + kBefore_mm) * direction_ +
                    beside * Vec2(-direction_.y, direction_.x);
    return solid_->solid_at(Vec3(at, z), within_mm_);
  }
  const double p = arc_radius_ + beside;
  const double angle = start_angle_ + turn_ * (along_ + along + kBefore_mm / p);
  return solid_->solid_at(Vec3(center_ + p * Vec2(std::cos(angle), std::sin(angle)), z),
                          within_mm_);
}

/// How much of a line's height is material before the cutter.
double FrontSection::height_at(double beside) const {
  double reach = 0;
  if (!reach_of(beside, reach)) return 0;
  const double lowest = lowest_along(beside, reach);
  const auto low_at = [&](double along) { return lift(distance(beside, along)) - slope_ * along; };
  const double bottom = low_at(lowest), at_reach = low_at(reach);
  const double top = box_.max.z - tip_z_ - std::min(slope_ * lowest, slope_ * reach);
  if (top <= bottom) return 0;
  const auto solid_at = [&](double y) {
    double in = lowest, out = reach;
    if (y >= at_reach) in = reach;
    for (int i = 0; i < kFrontHalvings && in < out; ++i) {
      const double middle = 0.5 * (in + out);
      (low_at(middle) <= y ? in : out) = middle;
    }
    return is_solid(beside, in, y);
  };
  // From just above the cutter up; edges are where two places differ.
  const double least = 1e-6, high = top - least;
  double at = bottom + least, length = 0;
  bool was = solid_at(at);
  double begin = bottom, step = std::max(kFirst * cell_, (high - at) * 1e-3);
  for (int n = 0; n < kMostPlaces && at < high; ++n) {
    const double next = n + 1 == kMostPlaces || at + 1.5 * step >= high ? high : at + step;
    const bool is = solid_at(next);
    if (is != was) {
      double low = at, up = next;
      for (int i = 0; i < kEdgeHalvings; ++i) {
        const double middle = 0.5 * (low + up);
        (solid_at(middle) == was ? low : up) = middle;
      }
      if (was) length += 0.5 * (low + up) - begin;
      begin = 0.5 * (low + up);
      was = is;
    }
    at = next;
    step = std::min(step * (1 + kGrows), std::max(step, 0.2 * radius_));
  }
  return was ? length + top - begin : length;
}

/// Over all lines, from side to side: those near the sides are closer together.
template <class Length>
double FrontSection::integrate(const Length& length) const {
  struct Panel {
    double a, b, at_a, at_m, at_b;
    int halvings;
  };
  const auto at = [&](double angle) { return length(angle) * std::cos(angle); };
  std::vector<Panel> open;
  double greatest = 0, sum = 0;
  double at_a = 0;
  for (int k = 0; k < kPanels; ++k) {
    const double a = kPi * (static_cast<double>(k) / kPanels - 0.5), b = a + kPi / kPanels;
    const double at_b = k + 1 == kPanels ? 0 : at(b);
    const double at_m = at(0.5 * (a + b));
    open.push_back({a, b, at_a, at_m, at_b, kHalvings});
    greatest = std::max({greatest, at_m, at_b});
    at_a = at_b;
  }
  while (!open.empty()) {
    const Panel p = open.back();
    open.pop_back();
    const double m = 0.5 * (p.a + p.b), width = p.b - p.a;
    const double left = at(0.5 * (p.a + m)), right = at(0.5 * (m + p.b));
    const double whole = width / 6 * (p.at_a + 4 * p.at_m + p.at_b);
    const double halves = width / 12 * (p.at_a + 4 * left + 2 * p.at_m + 4 * right + p.at_b);
    if (p.halvings == 0 || std::abs(whole - halves) <= kPanelError * greatest) {
      sum += halves;
      continue;
    }
    open.push_back({p.a, m, p.at_a, left, p.at_m, p.halvings - 1});
    open.push_back({m, p.b, p.at_m, right, p.at_b, p.halvings - 1});
  }
  return sum * engaged_;
}

/// Straight down: how much of a line across the disc is material, times the rest of it.
double FrontSection::disc_at(double angle) const {
  const double beside = engaged_ * std::sin(angle);
  const double half = std::sqrt(std::max(0.0, engaged_ * engaged_ - beside * beside));
  int solid = 0;
  for (int k = 0; k < kRings; ++k) {
    const double along = half * (2 * (k + 0.5) / kRings - 1);
    looks_ += 1;
    const double y = lift(std::hypot(beside, along)) - kBefore_mm;
    const Vec3 at(from_.x + along, from_.y + beside, tip_z_ + y);
    solid += solid_->solid_at(at, within_mm_) ? 1 : 0;
  }
  return 2 * half * solid / kRings;
}

double FrontSection::mm2_at(double part, const SolidPoints& solid, double within_mm) {
  if (engaged_ <= 0 || way_mm_ <= 0) return 0;
  solid_ = &solid;
  within_mm_ = within_mm;
  along_ = part * length_;
  tip_z_ = from_.z + slope_ * (length_ > 0 ? along_ : part);
  if (length_ == 0) {
    return slope_ > 0 ? 0 : integrate([this](double angle) { return disc_at(angle); });
  }
  const double mm = arc_ ? arc_radius_ : 1;  // of one along
  const double area = integrate([this, mm](double angle) {
    const double beside = engaged_ * std::sin(angle);
    return height_at(beside) * (arc_ ? (arc_radius_ + beside) / mm : 1);
  });
  return area * length_ * mm / way_mm_;
}

}  // namespace kerf
