// twin/process/milling/front_rays.h - a tool's front, looked at in directions from one side to the
// other: how what is found in each comes together.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/geometry.h"
#include "twin/process/engagement.h"

namespace kerf {

/// Material in one direction from the tool's middle.
struct FrontContact {
  double radius_mm = 0;  ///< out to here; 0: there is none
  double inner_mm = 0;   ///< from here on
  double deep_mm = 0;    ///< the greatest height over what the cutter leaves there
  double edge_mm = 0;    ///< so much of the profile is in it
};

/// Asks for the contact in some directions, and in more where material begins and ends (each of
/// these to a 32nd of the directions' distance). Angles are from straight ahead to the left.
/// What lies between two directions, with none of it in either, is not seen.
class FrontRays {
 public:
  /// `count`: directions but one, of kMost at most.
  FrontRays(int count, double radius_mm) : count_(count), radius_mm_(radius_mm) {}
  static constexpr int kMost = 18;

  /// `contact_at(angle)` gives a FrontContact.
  template <class ContactAt>
  void sweep(const ContactAt& contact_at);
  /// angle, width, depth, entry, exit, climb, effective diameter and edge of all that was found.
  EngagementLook look(bool anticlockwise) const;

 private:
  static constexpr int kHalvings = 5;
  /// The outermost two are so near to the sides.
  static constexpr double kRim_rad = 1.0 * kPi / 180;
  /// A direction counts where the cutter is in material out to this part of the farthest it is:
  /// near its tip a ball is in material all round.
  static constexpr double kOuterPart = 0.5;

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
  }
  void widen(double radius_mm, double angle) {
    low_mm_ = std::min(low_mm_, radius_mm * std::sin(angle));
    high_mm_ = std::max(high_mm_, radius_mm * std::sin(angle));
  }
  /// All between the two is in material.
  void count(double from, double to) {
    if (to <= from) return;
    if (found_.angle_rad <= 0) right_rad_ = from;
    left_rad_ = to;
    found_.angle_rad += to - from;
    right_of_way_rad_ += std::min(to, 0.0) - std::min(from, 0.0);
  }

  int count_;
  double radius_mm_;
  EngagementLook found_;
  double low_mm_ = std::numeric_limits<double>::infinity(), high_mm_ = -low_mm_;
  double left_rad_ = 0, right_rad_ = 0;
  double right_of_way_rad_ = 0;  ///< of angle_rad
};

template <class ContactAt>
void FrontRays::sweep(const ContactAt& contact_at) {
  std::array<FrontContact, kMost + 1> contacts;
  double farthest_mm = 0;
  for (int k = 0; k <= count_; ++k) {
    FrontContact& contact = contacts[static_cast<std::size_t>(k)];
    contact = contact_at(direction(k));
    note(contact, direction(k));
    farthest_mm = std::max(farthest_mm, contact.radius_mm);
  }
  if (farthest_mm <= 0) return;
  const auto counts = [&](const FrontContact& contact) {
    return contact.radius_mm >= kOuterPart * farthest_mm;
  };
  for (int k = 1; k <= count_; ++k) {
    const double from = k == 1 ? -kPi / 2 : direction(k - 1);
    const double to = k == count_ ? kPi / 2 : direction(k);
    const bool was = counts(contacts[static_cast<std::size_t>(k - 1)]);
    const bool is = counts(contacts[static_cast<std::size_t>(k)]);
    if (is == was) {
      if (is) count(from, to);
      continue;
    }
    double in = is ? direction(k) : direction(k - 1), off = is ? direction(k - 1) : direction(k);
    double radius_mm = 0;
    for (int n = 0; n < kHalvings; ++n) {
      const double middle = 0.5 * (in + off);
      const FrontContact contact = contact_at(middle);
      note(contact, middle);
      if (counts(contact)) radius_mm = contact.radius_mm;
      (counts(contact) ? in : off) = middle;
    }
    const double edge = 0.5 * (in + off);
    if (radius_mm > 0) widen(radius_mm, edge);
    count(is ? edge : from, is ? to : edge);
  }
}

}  // namespace kerf
