// twin/page/page_curve.h - values over time as a picture in a page.
#pragma once

#include <span>
#include <string>

namespace kerf {

/// One line of a picture of its own: columns of `step_s`, from 0 on.
struct PageCurve {
  std::string title;
  std::string unit;   ///< beside the greatest value
  std::string color;  ///< "#305080"
  double step_s = 1;
  std::span<const double> values;
  std::span<const double> high{};  ///< ends of ranges; empty: there are none
  double limit = 0;                ///< 0: none is known
};

/// An <svg> element as wide as its place; the axis of values begins at 0, and ends at the greatest
/// or, where that is a peak beyond all others, below it (scale_of()): such columns have a mark.
/// Empty: all are 0.
std::string curve_svg(const PageCurve& curve);

}  // namespace kerf
