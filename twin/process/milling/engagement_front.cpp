// EngagementScan at one place of the way: what the cutter's side has in it there.
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "twin/process/milling/engagement_scan.h"

namespace kerf {
namespace {

/// What is thinner is not there: what a pass leaves of the one before, by rounding.
constexpr double kThinnestFront_mm = 0.002;
/// Directions to begin with, from one side to the other; where material begins and ends they are
/// halved.
constexpr int kRays = 18, kRaysOfRound = 12, kRayHalvings = 5;
/// The outermost two are so near to the sides.
constexpr double kRim_rad = 1.0 * kPi / 180;
/// Radii along a ray, of cutters that are not flat, and halvings between two of them.
constexpr int kRadii = 6, kRadiusHalvings = 4;
/// A move of fewer cells is one of many.
constexpr double kShort_cells = 8;
/// Rounding of the cutter's own radius.
constexpr double kSameRadius = 1e-9;
/// A direction counts where the cutter is in material out to this part of the farthest it is: near
/// its tip a ball is in material all round.
constexpr double kOuterPart = 0.5;
/// Places across the disc of one that goes straight down, each way.
constexpr int kDiscPlaces = 24;

}  // namespace

/// It is going to be cut by the rest of the move; of one that is short, as others will follow, by
/// about a cell more.
bool EngagementScan::is_on_way(const Station& station, const Vec2& point) const {
  if (!station.is_near_end) return true;
  const double most = radius_ + (length_ < kShort_cells * cell_ ? 0.5 * cell_ : 0);
  const Vec2 arm = point - station.end;
  if (glm::dot(arm, arm) < most * most) return true;
  return arc_ ? place_of(point).along <= sweep_ : glm::dot(arm, direction_) <= 0;
}

/// The material of the cell in which `point` is, above the lowest the cutter comes there with its
/// middle beside it; 0: there is none, or the cutter passes the cell's middle by.
double EngagementScan::material_at(const Station& station, const Vec2& point, double least_radius,
                                   bool at_rim) const {
  const Box& box = heights_->bounds_mm();
  const double cell_x = heights_->cell_x_mm(), cell_y = heights_->cell_y_mm();
  const double i = std::floor((point.x - box.min.x) / cell_x);
  const double j = std::floor((point.y - box.min.y) / cell_y);
  if (i < 0 || j < 0 || i >= heights_->nx() || j >= heights_->ny()) return 0;
  const Vec2 middle(box.min.x + (i + 0.5) * cell_x, box.min.y + (j + 0.5) * cell_y);
  const Vec2 arm = middle - station.center;
  const double ahead = glm::dot(arm, station.ahead);
  const double beside = arc_ ? glm::length(middle - center_) - arc_radius_
                             : station.ahead.x * arm.y - station.ahead.y * arm.x;
  if (std::abs(beside) >= radius_ || !is_on_way(station, middle)) return 0;
  const auto lift = [&](double radius) {
    return lift_[static_cast<std::size_t>(std::min(radius * lift_scale_, double{kLifts}))];
  };
  double height = static_cast<double>(heights_->height(static_cast<int>(i), static_cast<int>(j)));
  const double tip = std::max(station.tip_z, box.min.z);
  const double lowest = tip + lift(std::abs(beside));
  const double meets =
      kThinnestFront_mm + tip +
      lift(at_rim ? least_radius * (1 - 1e-9) : std::min(glm::length(arm), radius_));
  if (height <= meets || ahead < -cell_) return 0;
  height = behind_held(middle, height);
  return height > meets ? height - lowest : 0;
}

/// What stands right before the rim. Near the sides the rim is steep: as far ahead, and as far
/// within the way, as it takes for the middle of the cell to be outside of the rim and within the
/// way, however it lies.
Vec2 EngagementScan::before_rim(const Station& station, double angle) const {
  const Vec2 left(-station.ahead.y, station.ahead.x);
  const double half = 0.5 * cell_ * (std::abs(left.x) + std::abs(left.y)) * (1 + 1e-6);
  if (!arc_) {
    const double most = std::max(0.0, radius_ - half);
    const double lane = std::clamp(radius_ * std::sin(angle), -most, most);
    const double inner = std::max(0.0, std::abs(lane) - half);
    return station.center + lane * left +
           (std::sqrt(radius_ * radius_ - inner * inner) + half) * station.ahead;
  }
  // Lanes of an arc go round with it.
  const double r = arc_radius_;
  const Vec2 rim =
      station.center + radius_ * (std::sin(angle) * left + std::cos(angle) * station.ahead);
  const double least = std::min(std::max(r - radius_ + half, half), r);
  const double arm =
      std::clamp(glm::length(rim - center_), least, std::max(r + radius_ - half, least));
  double turn = 0;
  for (const double beside : {arm - half, arm, arm + half}) {
    const double p = std::max(beside, half);
    const double cosine = (r * r + p * p - radius_ * radius_) / (2 * r * p);
    turn = std::max(turn, std::acos(std::clamp(cosine, -1.0, 1.0)));
  }
  turn = std::min(turn + half / arm, kPi);
  const Vec2 out = (station.center - center_) / r;
  return center_ + arm * (std::cos(turn) * out + std::sin(turn) * station.ahead);
}

/// Along one direction, the angle from straight ahead: where the cutter ends in material.
EngagementScan::Contact EngagementScan::contact_at(const Station& station, double angle) const {
  const Vec2 left(-station.ahead.y, station.ahead.x);
  const Vec2 out = std::cos(angle) * station.ahead + std::sin(angle) * left;
  Contact found;
  const auto look = [&](double radius) {
    const double deep = material_at(station, station.center + radius * out, radius, false);
    if (deep > 0) found = {radius, std::max(deep, found.deep_mm)};
    return deep > 0;
  };
  if (engaged_ >= radius_ * (1 - kSameRadius)) {
    const double deep = material_at(station, before_rim(station, angle), radius_, true);
    if (deep > 0) return {radius_, deep};
  }
  if (is_flat()) return found;
  const double step = (engaged_ - flat_radius_) / kRadii;
  double outside = engaged_;
  for (int k = 0; k < kRadii; ++k) {
    const double radius = engaged_ - (k + 0.5) * step;
    if (!look(radius)) {
      outside = radius;
      continue;
    }
    double inside = radius;
    for (int n = 0; n < kRadiusHalvings; ++n) {
      const double middle = 0.5 * (inside + outside);
      (look(middle) ? inside : outside) = middle;
    }
    found.radius_mm = 0.5 * (inside + outside);
    // Deepest nearer to the middle.
    const double radius_mm = found.radius_mm;
    look(0.5 * inside);
    return {radius_mm, found.deep_mm};
  }
  return found;
}

EngagementLook EngagementScan::plunge_at(const Station& station) const {
  EngagementLook look;
  look.is_plunge = true;
  if (rise_ >= 0) return look;
  double widest = 0;
  for (int y = 0; y < kDiscPlaces; ++y) {
    for (int x = 0; x < kDiscPlaces; ++x) {
      const Vec2 at = engaged_ * (2.0 * (Vec2(x, y) + 0.5) / double{kDiscPlaces} - 1.0);
      const double radius = glm::length(at);
      if (radius >= engaged_) continue;
      const double deep = material_at(station, station.center + at, radius, false);
      look.deep_mm = std::max(look.deep_mm, deep);
      if (deep > 0) widest = std::max(widest, radius);
    }
  }
  if (look.deep_mm > 0) look.angle_rad = 2 * kPi, look.wide_mm = 2 * widest;
  return look;
}

EngagementLook EngagementScan::look_ahead(const HeightGrid& heights, const Cutter& cutter,
                                          const CutMove& move, double at, const CutMove* held) {
  set(heights, cutter, move);
  set_held(held);
  engaged_ = engaged_radius();
  Station station;
  station.tip_z = z_ + rise_ * at;
  const auto place = [this](double part) {
    return point_of(arc_ ? Place{part * sweep_, arc_radius_} : Place{part * length_, 0});
  };
  station.center = place(at);
  station.end = place(1);
  station.is_near_end = length_ > 0 && (1 - at) * length_ < 2 * radius_ + kShort_cells * cell_;
  station.ahead = direction_;
  if (arc_) {
    const Vec2 out = (station.center - center_) / arc_radius_;
    station.ahead = turn_ * Vec2(-out.y, out.x);
  }
  if (engaged_ <= 0) return {};
  if (length_ == 0) return plunge_at(station);
  EngagementLook look;
  double low_mm = std::numeric_limits<double>::infinity(), high_mm = -low_mm;
  const auto note = [&](const Contact& contact, double angle) {
    if (contact.radius_mm <= 0) return;
    look.deep_mm = std::max(look.deep_mm, contact.deep_mm);
    low_mm = std::min(low_mm, contact.radius_mm * std::sin(angle));
    high_mm = std::max(high_mm, contact.radius_mm * std::sin(angle));
  };
  const int rays = is_flat() ? kRays : kRaysOfRound;
  const auto direction = [rays](int k) {
    if (k == 0) return kRim_rad - kPi / 2;
    if (k == rays) return kPi / 2 - kRim_rad;
    return kPi * (static_cast<double>(k) / rays - 0.5);
  };
  // Flat cutters are in material at their rim or not at all.
  std::array<Contact, kRays + 1> contacts;
  double farthest_mm = 0;
  for (int k = 0; k <= rays; ++k) {
    contacts[static_cast<std::size_t>(k)] = contact_at(station, direction(k));
    note(contacts[static_cast<std::size_t>(k)], direction(k));
    farthest_mm = std::max(farthest_mm, contacts[static_cast<std::size_t>(k)].radius_mm);
  }
  if (farthest_mm <= 0) return {};
  const auto counts = [&](const Contact& contact) {
    return contact.radius_mm >= kOuterPart * farthest_mm;
  };
  for (int k = 1; k <= rays; ++k) {
    const double from = k == 1 ? -kPi / 2 : direction(k - 1);
    const double to = k == rays ? kPi / 2 : direction(k);
    const bool was = counts(contacts[static_cast<std::size_t>(k - 1)]);
    const bool is = counts(contacts[static_cast<std::size_t>(k)]);
    if (is == was) {
      if (is) look.angle_rad += to - from;
      continue;
    }
    double in = is ? direction(k) : direction(k - 1), off = is ? direction(k - 1) : direction(k);
    for (int n = 0; n < kRayHalvings; ++n) {
      const double middle = 0.5 * (in + off);
      const Contact contact = contact_at(station, middle);
      note(contact, middle);
      (counts(contact) ? in : off) = middle;
    }
    const double edge = 0.5 * (in + off);
    look.angle_rad += is ? to - edge : edge - from;
  }
  if (look.angle_rad <= 0) return {};
  // Up to the rim itself, where the outermost rays are in it.
  const double rim = std::sin(kPi / 2 - kRim_rad);
  low_mm = low_mm < 0 ? std::max(low_mm / rim, -radius_) : low_mm;
  high_mm = high_mm > 0 ? std::min(high_mm / rim, radius_) : high_mm;
  look.wide_mm = high_mm - low_mm;
  return look;
}

}  // namespace kerf
