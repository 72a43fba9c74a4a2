// stock/turning/bar_flats.h - the flats of a hexagonal or square bar that is turned.
//
//        .--.--.--.        A turned part is a region beside its axis, what lies between the
//        inscribed
//       / .'    '. \       circle of the bar and its corners is there for a part of a turn alone.
//      / /        \ \      Regions are those of the round bar through the corners; the flats are
//      \ \        / /      taken off where volumes are added up and surfaces are made.
//       \ '.    .' /
//        '--'--'--'
#pragma once

#include <cmath>
#include <span>

#include "base/geometry.h"
#include "base/portable_math.h"
#include "stock/turning/contour.h"

namespace kerf {

/// The first flat faces +X of the workpiece frame.
struct BarFlats {
  int count = 0;
  double inner_radius_mm = 0;  ///< half the width across flats
  double outer_radius_mm() const { return inner_radius_mm / portable::cos(kPi / count); }
  /// How far the bar reaches at this angle about the axis.
  double reach_mm(double angle_rad) const;
  bool operator==(const BarFlats&) const = default;
};

namespace turning {

/// What the flats take off the volume of a region that turns, mm3. Exact but for rounding of
/// doubles: edges are integrated in closed form. O(runs, and corners beyond the inscribed circle).
double missing_mm3(std::span<const Contour> contours, const BarFlats& flats);
double missing_mm3(const Contour& contour, const BarFlats& flats);

}  // namespace turning
}  // namespace kerf
