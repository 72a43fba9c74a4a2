// twin/process/milling/front_rays.h - a tool's front, looked at in directions from one side to the
// other: how what is found in each comes together.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "base/geometry.h"
#include "twin/process/engagement.h"

namespace kerf {

/// Material in one direction from the tool's middle.
struct FrontContact {
  double radius_mm = 0;  ///< out to here; 0: there is none
  double inner_mm = 0;   ///< from here on
  double deep_mm = 0;    ///< the greatest height over what the cutter leaves there
  double edge_mm = 0;    ///< so much of the profile is in it
  double high_mm = 0;    ///< the height of that; what is next to nothing counts by its thickness
};

/// A direction from the tool's middle, from straight ahead to the left.
struct FrontWay {
  double rad = 0, ahead = 1, left = 0;  ///< its cosine and sine
  static FrontWay of(double rad) { return {rad, std::cos(rad), std::sin(rad)}; }
};

/// Asks for the contact in some directions, and in more where it changes (down to a 32nd of the
/// directions' distance). Angles are from straight ahead to the left. What lies between two
/// directions, with none of it in either, is not seen.
///
/// A flat tool's directions are in material or not, and its angle is that of those that are. What
/// is not flat is in material higher up in one direction than in another, and where that begins
/// with next to nothing there is no place to point at. Its directions count by that height h: the
/// angle is (the sum of h)^2 / the sum of h^2, which is that of an even height where it is even;
/// entry and exit are those of an even height with the same middle and the same spread. The width
/// is that of its spans in material, seen along the way, without the gaps between them.
class FrontRays {
 public:
  /// `count`: directions but one, of kMost at most.
  FrontRays(int count, double radius_mm, bool is_flat)
      : count_(count), radius_mm_(radius_mm), is_flat_(is_flat) {}
  static constexpr int kMost = 18;
  static constexpr std::size_t kSteps = 72;  ///< of take()

  /// `contact_at(angle)` gives a FrontContact.
  template <class ContactAt>
  void sweep(const ContactAt& contact_at);
  /// Instead: what is known at even steps from one side to the other, of what is not flat, and of
  /// the lateral places from `low_mm` to `high_mm` (to the left) where it is in material.
  /// `wall_at(FrontWay)`: what stands over the profile's end besides (edge_mm) and how deep that
  /// is; asked for at the steps, and more closely where it begins or ends.
  template <class WallAt>
  void take(std::span<const FrontContact, kSteps + 1> contacts, const WallAt& wall_at,
            double low_mm, double high_mm);
  /// angle, width, depth, entry, exit, climb, effective diameter and edge of all that was found.
  EngagementLook look(bool anticlockwise) const;

 private:
  static constexpr int kHalvings = 5;
  /// The outermost two are so near to the sides.
  static constexpr double kRim_rad = 1.0 * kPi / 180;
  /// Heights that differ by less than this part of the greatest are taken to change evenly.
  static constexpr double kEven = 0.03;

  struct Direction {
    double angle = 0, high_mm = 0;
    /// Of what is in material, across the way, to the left; right > left: nothing is.
    double right_mm = 1, left_mm = 0;
  };
  static Direction direction_of(double angle, const FrontContact& contact) {
    return direction_of(angle, contact.radius_mm > 0 ? std::sin(angle) : 0, contact);
  }
  static Direction direction_of(double angle, double sine, const FrontContact& contact) {
    Direction at{angle, contact.high_mm};
    if (contact.radius_mm <= 0) return at;
    const double inner_mm = contact.inner_mm * sine, outer_mm = contact.radius_mm * sine;
    at.right_mm = std::min(inner_mm, outer_mm), at.left_mm = std::max(inner_mm, outer_mm);
    return at;
  }
  double direction(int k) const {
    if (k == 0) return kRim_rad - kPi / 2;
    if (k == count_) return kPi / 2 - kRim_rad;
    return kPi * (static_cast<double>(k) / count_ - 0.5);
  }
  void note(const FrontContact& contact, double angle) {
    if (contact.radius_mm <= 0) return;
    found_.deep_mm = std::max(found_.deep_mm, contact.deep_mm);
    found_.effective_mm = std::max(found_.effective_mm, 2 * contact.radius_mm);
    found_.contact_mm = std::max(found_.contact_mm, contact.edge_mm);
    widen(contact.radius_mm, angle);
    // Beside its middle it may be in material farther in than where the rim comes out of it.
    if (!is_flat_ && contact.inner_mm > 0) widen(contact.inner_mm, angle);
  }
  void widen(double radius_mm, double angle) {
    const double left_mm = radius_mm * std::sin(angle);
    low_mm_ = std::min(low_mm_, left_mm), high_mm_ = std::max(high_mm_, left_mm);
  }
  /// Of the k-th of kSteps, from straight ahead.
  static double step_rad(std::size_t k) { return kPi * (static_cast<double>(k) / kSteps - 0.5); }
  /// The same, those at the very sides a little before them.
  static const std::array<FrontWay, kSteps + 1>& step_ways();
  static const std::array<double, kSteps + 1>& step_sines();
  /// All between the two is in material.
  void count(double from, double to) {
    if (to <= from) return;
    if (found_.angle_rad <= 0)
      right_rad_ = from;
    else if (from > left_rad_)
      found_.gaps_mm += radius_mm_ * (std::sin(from) - std::sin(left_rad_));
    left_rad_ = to;
    found_.angle_rad += to - from;
    right_of_way_rad_ += std::min(to, 0.0) - std::min(from, 0.0);
  }
  template <class ContactAt>
  void find_edge(const ContactAt& contact_at, int k, bool is);
  template <class ContactAt>
  void weigh(const ContactAt& contact_at, const Direction& from, const Direction& to, int halvings);
  void add(const Direction& from, const Direction& to);
  void settle();
  struct Span {
    double right_mm, left_mm;
  };
  /// What lies between two directions that are both in material is, too.
  void span(const Direction& from, const Direction& to) {
    const bool was = from.right_mm <= from.left_mm, is = to.right_mm <= to.left_mm;
    if (was && is)
      add_span({std::min(from.right_mm, to.right_mm), std::max(from.left_mm, to.left_mm)});
    else if (was || is)
      add_span(was ? Span{from.right_mm, from.left_mm} : Span{to.right_mm, to.left_mm});
  }
  void add_span(const Span& span);
  double gaps_mm();

  int count_;
  double radius_mm_;
  bool is_flat_;
  EngagementLook found_;
  double low_mm_ = std::numeric_limits<double>::infinity(), high_mm_ = -low_mm_;
  double left_rad_ = 0, right_rad_ = 0;
  /// Of what is not flat, across the way; and how far they may be apart and belong together.
  std::vector<Span> spans_;
  double apart_mm_ = 0;
  double right_of_way_rad_ = 0;  ///< of angle_rad
  /// Integrals over the directions: of the height h, of h * angle, h * angle^2, h^2, and of h on
  /// the right of the way.
  struct Heights {
    double plain = 0, angle = 0, angle2 = 0, square = 0, right = 0;
  } heights_;
  double highest_mm_ = 0;
};

template <class ContactAt>
void FrontRays::sweep(const ContactAt& contact_at) {
  std::array<FrontContact, kMost + 1> contacts;
  for (int k = 0; k <= count_; ++k) {
    FrontContact& contact = contacts[static_cast<std::size_t>(k)];
    contact = contact_at(direction(k));
    note(contact, direction(k));
    highest_mm_ = std::max(highest_mm_, contact.high_mm);
  }
  if (found_.effective_mm <= 0) return;
  const auto at = [&](int k) {
    return direction_of(direction(k), contacts[static_cast<std::size_t>(k)]);
  };
  if (!is_flat_) {
    add({-kPi / 2, at(0).high_mm}, at(0));
    for (int k = 1; k <= count_; ++k) weigh(contact_at, at(k - 1), at(k), kHalvings);
    add(at(count_), {kPi / 2, at(count_).high_mm});
    return settle();
  }
  for (int k = 1; k <= count_; ++k) {
    const bool was = contacts[static_cast<std::size_t>(k - 1)].radius_mm > 0;
    const bool is = contacts[static_cast<std::size_t>(k)].radius_mm > 0;
    if (is != was) {
      find_edge(contact_at, k, is);
    } else if (is) {
      count(k == 1 ? -kPi / 2 : direction(k - 1), k == count_ ? kPi / 2 : direction(k));
    }
  }
}

/// Between the direction k and the one before it, one of which is in material.
template <class ContactAt>
void FrontRays::find_edge(const ContactAt& contact_at, int k, bool is) {
  const double from = k == 1 ? -kPi / 2 : direction(k - 1);
  const double to = k == count_ ? kPi / 2 : direction(k);
  double in = is ? direction(k) : direction(k - 1), off = is ? direction(k - 1) : direction(k);
  double radius_mm = 0;
  for (int n = 0; n < kHalvings; ++n) {
    const double middle = 0.5 * (in + off);
    const FrontContact contact = contact_at(middle);
    note(contact, middle);
    if (contact.radius_mm > 0) radius_mm = contact.radius_mm;
    (contact.radius_mm > 0 ? in : off) = middle;
  }
  const double edge = 0.5 * (in + off);
  if (radius_mm > 0) widen(radius_mm, edge);
  count(is ? edge : from, is ? to : edge);
}

template <class WallAt>
void FrontRays::take(std::span<const FrontContact, kSteps + 1> contacts, const WallAt& wall_at,
                     double low_mm, double high_mm) {
  low_mm_ = low_mm, high_mm_ = high_mm;
  const std::array<double, kSteps + 1>& sines = step_sines();
  // Where it begins and ends is somewhere between two steps.
  apart_mm_ = radius_mm_ * kPi / kSteps;
  // Steps at the very sides are a little before them: what is at a side itself is passed by.
  const std::array<FrontWay, kSteps + 1>& ways = step_ways();
  const auto note_wall = [&](const FrontContact& at, const FrontContact& wall, std::size_t k) {
    FrontContact both = at;
    if (wall.edge_mm > 0) {
      both.radius_mm = radius_mm_;
      both.deep_mm = std::max(at.deep_mm, wall.deep_mm);
      both.edge_mm += wall.edge_mm;
    }
    if (both.radius_mm <= 0) return;
    const Direction across = direction_of(step_rad(k), sines[k], both);
    add_span({across.right_mm, across.left_mm});
    found_.deep_mm = std::max(found_.deep_mm, both.deep_mm);
    found_.effective_mm = std::max(found_.effective_mm, 2 * both.radius_mm);
    found_.contact_mm = std::max(found_.contact_mm, both.edge_mm);
    if (wall.edge_mm > 0) widen(radius_mm_, step_rad(k));
  };
  FrontContact before = wall_at(ways[0]);
  note_wall(contacts[0], before, 0);
  Direction last = direction_of(step_rad(0), sines[0], contacts[0]);
  for (std::size_t k = 1; k <= kSteps; ++k) {
    const FrontContact wall = wall_at(ways[k]);
    note_wall(contacts[k], wall, k);
    const Direction next = direction_of(step_rad(k), sines[k], contacts[k]);
    span(last, next);
    last = next;
    const double from = step_rad(k - 1), to = step_rad(k);
    const double low = contacts[k - 1].high_mm, high = contacts[k].high_mm;
    if ((before.edge_mm > 0) == (wall.edge_mm > 0)) {
      const double from_mm = low + before.edge_mm, to_mm = high + wall.edge_mm;
      if (from_mm > 0 || to_mm > 0) add({from, from_mm}, {to, to_mm});
    } else {
      const bool begins = wall.edge_mm > 0;
      const FrontContact& known = begins ? wall : before;
      double in = begins ? to : from, off = begins ? from : to;
      for (int n = 0; n < kHalvings; ++n) {
        const double middle = 0.5 * (in + off);
        (wall_at(FrontWay::of(middle)).edge_mm > 0 ? in : off) = middle;
      }
      const double edge = 0.5 * (in + off),
                   there = low + (edge - from) / (to - from) * (high - low);
      widen(radius_mm_, edge);
      add({from, low + before.edge_mm}, {edge, there + (begins ? 0 : known.edge_mm)});
      add({edge, there + (begins ? known.edge_mm : 0)}, {to, high + wall.edge_mm});
    }
    before = wall;
  }
  if (found_.effective_mm > 0) settle();
}

/// In halves, as long as heights do not change evenly.
template <class ContactAt>
void FrontRays::weigh(const ContactAt& contact_at, const Direction& from, const Direction& to,
                      int halvings) {
  if (halvings == 0 || std::abs(to.high_mm - from.high_mm) <= kEven * highest_mm_)
    return add(from, to);
  const double angle = 0.5 * (from.angle + to.angle);
  const FrontContact contact = contact_at(angle);
  note(contact, angle);
  highest_mm_ = std::max(highest_mm_, contact.high_mm);
  const Direction middle = direction_of(angle, contact);
  const double even_mm = 0.5 * (from.high_mm + to.high_mm);
  const bool goes_on = std::abs(middle.high_mm - even_mm) > kEven / 4 * highest_mm_;
  weigh(contact_at, from, middle, goes_on ? halvings - 1 : 0);
  weigh(contact_at, middle, to, goes_on ? halvings - 1 : 0);
}

}  // namespace kerf
