#include "twin/process/milling/solid_front.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "twin/motion/motion_geometry.h"
#include "twin/process/milling/way_profile.h"

namespace kerf {
namespace {

constexpr int kDirections = FrontRays::kMost, kBottomRadii = 6, kEdgeHalvings = 5;
/// What is asked about lies so far ahead, of cells and of the radius: what was cut before ends at
/// the tool.
constexpr double kAheadOfCell = 0.5, kAheadOfRadius = 1.0 / 200;
/// Up the side: the first place, of cells, and how each step grows; the top to a 64th of a step.
constexpr double kFirstStep = 0.5, kStepGrows = 1.25;
constexpr int kMostSteps = 48, kTopHalvings = 6;
constexpr double kInside = 1 - 1e-9;
/// Along the spindle, or so nearly that there is no ahead.
constexpr double kStraight = 1e-6;
/// Rings and directions of a disc that goes straight down.
constexpr int kRings = 8, kRound = 24;
constexpr double kStraightBelow_mm = 1e-6;

double flat_radius_of(const Cutter& cutter) {
  double flat = 0, rises = cutter.radius_mm();
  if (cutter.height_mm(rises * kInside) <= 0) return rises;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (flat + rises);
    (cutter.height_mm(middle) <= 1e-9 ? flat : rises) = middle;
  }
  return flat;
}

}  // namespace

bool SolidFront::takes(const Cutter& cutter, const CutMove& move) {
  if (cutter.undercuts() || cutter.footprint() != nullptr) return false;
  if (!move.arc) return glm::length(move.to_mm - move.from_mm) > 0;
  return move.is_vertical() && std::abs(move.arc->axis.z) >= 1 - 1e-12;
}

/// The tool's place, so much ahead of the part of the way.
void SolidFront::set_place(const CutMove& move, double at, double ahead_mm) {
  const double part = at + ahead_mm / way_length_mm(move);
  Vec3 way = move.to_mm - move.from_mm;
  tip_ = move.from_mm + part * way;
  if (move.arc) {
    const CutArc& arc = *move.arc;
    const Vec2 arm(move.from_mm - arc.center_mm);
    const double sense = arc.sweep_rad * arc.axis.z, turned = sense * part;
    const Vec2 now(std::cos(turned) * arm.x - std::sin(turned) * arm.y,
                   std::sin(turned) * arm.x + std::cos(turned) * arm.y);
    tip_.x = arc.center_mm.x + now.x, tip_.y = arc.center_mm.y + now.y;
    way = Vec3(-now.y * sense, now.x * sense, way.z);
  }
  axis_ = glm::normalize(move.axis_from + at * (move.axis_to - move.axis_from));
  way = glm::normalize(way);
  const Vec3 sideways = way - glm::dot(way, axis_) * axis_;
  goes_sideways_ = glm::length(sideways) > kStraight;
  if (goes_sideways_) {
    ahead_ = glm::normalize(sideways);
  } else {
    const Vec3 other = std::abs(axis_.x) < 0.5 ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
    ahead_ = glm::normalize(other - glm::dot(other, axis_) * axis_);
  }
  left_ = glm::cross(axis_, ahead_);
}

bool SolidFront::is_solid(double radius, const Vec3& out, double height) const {
  const Vec3 at = tip_ + radius * kInside * out + height * axis_;
  for (int i = 0; i < 3; ++i) {
    if (at[i] < box_.min[i] || at[i] > box_.max[i]) return false;
  }
  return solid_->solid_at(at, within_);
}

/// How high above the cutter's surface at that radius material goes on; 0: it is not there.
double SolidFront::high_over(const Vec3& out, double radius) const {
  const double surface = cutter_->height_mm(radius * kInside);
  double at = surface + within_;
  if (!is_solid(radius, out, at)) return 0;
  double step = kFirstStep * cell_;
  for (int n = 0; n < kMostSteps && at < top_; ++n) {
    const double next = std::min(at + step, top_);
    if (!is_solid(radius, out, next)) {
      double in = at, free = next;
      for (int k = 0; k < kTopHalvings; ++k) {
        const double middle = 0.5 * (in + free);
        (is_solid(radius, out, middle) ? in : free) = middle;
      }
      return 0.5 * (in + free) - surface;
    }
    at = next;
    step *= kStepGrows;
  }
  return at - surface;
}

/// How much of the side, above the end of the profile, is in material: of what may lie higher up,
/// too.
double SolidFront::wall_mm(const Vec3& out) const {
  const double from_bottom = high_over(out, radius_);
  if (from_bottom > 0) return from_bottom;
  const double end = cutter_->height_mm(radius_ * kInside);
  double at = end, step = kFirstStep * cell_, first = -1, last = -1;
  for (int n = 0; n < kMostSteps && at < top_; ++n) {
    at = std::min(at + step, top_);
    step *= kStepGrows;
    if (!is_solid(radius_, out, at)) continue;
    if (first < 0) first = at;
    last = at;
  }
  return first < 0 ? 0 : std::max(last - first, kFirstStep * cell_);
}

/// Between a radius in material and one in none.
double SolidFront::edge_between(const Vec3& out, double in, double free) const {
  for (int k = 0; k < kEdgeHalvings; ++k) {
    const double middle = 0.5 * (in + free);
    const bool solid = is_solid(middle, out, cutter_->height_mm(middle * kInside) + within_);
    (solid ? in : free) = middle;
  }
  return 0.5 * (in + free);
}

/// Of the profile, from where it begins to rise: chords.
double SolidFront::profile_mm(double radius) const {
  constexpr int kChords = 64;
  double sum = 0, last = 0;
  for (int k = 1; k <= kChords && radius > flat_radius_; ++k) {
    const double next =
        cutter_->height_mm((flat_radius_ + (radius - flat_radius_) * k / kChords) * kInside);
    sum += std::hypot((radius - flat_radius_) / kChords, next - last);
    last = next;
  }
  return sum;
}

FrontContact SolidFront::contact_at(double angle) const {
  const Vec3 out = std::cos(angle) * ahead_ + std::sin(angle) * left_;
  FrontContact found;
  const double wall = wall_mm(out);
  const double beside = radius_ * std::abs(std::sin(angle));
  if (wall > 0) {
    const double end = cutter_->height_mm(radius_ * kInside);
    found = {radius_, 0, wall + end - cutter_->height_mm(beside * kInside), 0};
  }
  if (flat_radius_ < radius_) {
    const double step = (radius_ - flat_radius_) / kBottomRadii;
    double free = radius_;
    for (int k = 0; k < kBottomRadii && found.radius_mm <= 0; ++k) {
      const double radius = radius_ - (k + 0.5) * step;
      const double surface = cutter_->height_mm(radius * kInside);
      if (!is_solid(radius, out, surface + within_)) {
        free = radius;
        continue;
      }
      found.radius_mm = edge_between(out, radius, free);
    }
    if (found.radius_mm > 0) {
      const double nearer = 0.5 * found.radius_mm;
      const double high = high_over(out, nearer);
      if (high > 0) {
        const double lowest = cutter_->height_mm(nearer * std::abs(std::sin(angle)));
        const double surface = cutter_->height_mm(nearer * kInside);
        found.deep_mm = std::max(found.deep_mm, high + surface - lowest);
      } else {
        found.inner_mm = edge_between(out, found.radius_mm, nearer);
        const double middle = 0.5 * (found.inner_mm + found.radius_mm);
        const double lowest = cutter_->height_mm(middle * std::abs(std::sin(angle)));
        found.deep_mm = std::max(
            found.deep_mm, high_over(out, middle) + cutter_->height_mm(middle * kInside) - lowest);
      }
    }
  }
  if (found.radius_mm <= 0) return found;
  // Of a thin slice, which ends low nearer to the middle: there is material as far out as that.
  found.deep_mm =
      std::max(found.deep_mm, cutter_->height_mm(found.radius_mm * kInside) -
                                  cutter_->height_mm(found.radius_mm * std::abs(std::sin(angle))));
  found.high_mm = wall + cutter_->height_mm(found.radius_mm * kInside) -
                  cutter_->height_mm(found.inner_mm * kInside);
  found.edge_mm = wall + profile_mm(found.radius_mm) - profile_mm(found.inner_mm);
  return found;
}

EngagementLook SolidFront::plunge() const {
  EngagementLook look;
  look.is_plunge = true;
  double widest = 0;
  for (int ring = 0; ring < kRings; ++ring) {
    const double radius = radius_ * (ring + 0.5) / kRings;
    for (int k = 0; k < kRound; ++k) {
      const double angle = 2 * kPi * (k + 0.5 * (ring % 2)) / kRound;
      const double high = high_over(std::cos(angle) * ahead_ + std::sin(angle) * left_, radius);
      if (high <= 0) continue;
      look.deep_mm = std::max(look.deep_mm, high);
      widest = std::max(widest, std::min(radius_, radius + 0.5 * radius_ / kRings));
    }
  }
  if (look.deep_mm <= 0) return look;
  look.angle_rad = look.exit_rad = 2 * kPi;
  look.wide_mm = look.effective_mm = 2 * widest;
  look.contact_mm = profile_mm(widest);
  look.cuts_centre = is_solid(0, ahead_, within_);
  return look;
}

bool SolidFront::cuts_centre(const CutMove& move) const {
  if (glm::dot(move.to_mm - move.from_mm, axis_) >= 0) return false;
  return is_solid(0, ahead_, within_);
}

EngagementLook SolidFront::look(const SolidPoints& solid, const Box& box, double cell_mm,
                                const Cutter& cutter, const CutMove& move, const Asked& asked) {
  solid_ = &solid, cutter_ = &cutter;
  box_ = box, cell_ = cell_mm;
  radius_ = cutter.radius_mm();
  flat_radius_ = flat_radius_of(cutter);
  within_ = 1e-4 + cell_mm * cell_mm / (8 * radius_);
  set_place(move, asked.at, 0);
  top_ = glm::length(box.max - box.min);
  if (!goes_sideways_) {
    const bool down = glm::dot(move.to_mm - move.from_mm, axis_) < 0;
    return down ? plunge() : EngagementLook{};
  }
  const bool centre = cuts_centre(move);
  const double ahead_mm = flat_radius_ >= radius_ ? kAheadOfRadius * radius_ : kAheadOfCell * cell_;
  set_place(move, asked.at, std::max(ahead_mm, kStraightBelow_mm));
  FrontRays rays(kDirections, radius_, flat_radius_ >= radius_);
  rays.sweep([&](double angle) { return contact_at(angle); });
  EngagementLook look = rays.look(asked.anticlockwise);
  look.cuts_centre = centre && look.is_engaged();
  return look;
}

}  // namespace kerf
