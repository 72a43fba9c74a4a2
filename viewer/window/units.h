// viewer/window/units.h - the one place where the window turns lengths into figures. For the
// sources of viewer/ only.
#pragma once

#include <string>
#include <utility>

#include "base/length_unit.h"
#include "viewer/scene.h"

namespace kerf {

/// Figures of an inch have one digit more than those of a mm: both then show about a thousandth
/// of what a machine can do. A zero has no sign.
class Measures {
 public:
  explicit constexpr Measures(LengthUnit unit) : unit_(unit) {}

  LengthUnit unit() const { return unit_; }
  double mm_per_unit() const { return mm_of(unit_); }
  /// "mm", "in"
  const char* name() const { return name_of(unit_); }
  /// After the point, of a position.
  int digits() const { return is_inch() ? 4 : 3; }
  /// After the point, so that two values that are `step_mm` apart are told apart; at most 6.
  int digits_for(double step_mm) const;

  /// "12.500", "0.4921": of columns, whose unit is known.
  std::string position(double mm) const;
  /// "12.500 mm", "0.4921 in"
  std::string length(double mm) const { return length(mm, digits()); }
  std::string length(double mm, int digits) const;
  /// "+0.020 mm", "-0.0008 in"
  std::string signed_length(double mm) const { return signed_length(mm, digits()); }
  std::string signed_length(double mm, int digits) const;
  /// "1500 mm/min", "59.1 in/min"
  std::string feed(double mm_per_min) const;
  /// "1480 / 1500 mm/min": what is, and what was asked for.
  std::string feeds(double actual_mm_per_min, double wanted_mm_per_min) const;
  /// "12.3 cm³", "0.751 in³"
  std::string volume(double mm3) const;
  /// "120 mm³/s", "0.00732 in³/s"
  std::string rate(double mm3_per_s) const;
  /// "<= 120 mm³/s", "<= 0.00732 in³/s"
  std::string rate_up_to(double mm3_per_s) const;
  /// Of what a mode colours by (kRemovalRate to kBend), with its unit: "0.12 mm", "350 N".
  std::string value(ColorBy mode, double value) const;
  /// "100 .. 200 N"
  std::string values(ColorBy mode, double from, double to) const;

 private:
  constexpr bool is_inch() const { return unit_ == LengthUnit::kInch; }
  std::string feed_figure(double mm_per_min) const;
  /// What a mode's value is multiplied by, and the unit that it then has.
  std::pair<double, std::string> unit_of(ColorBy mode) const;

  LengthUnit unit_;
};

}  // namespace kerf
