// stock/turning/engagement.h - how a tool was in the material that it removed on a straight way.
#pragma once

#include <array>
#include <span>

#include "stock/turning/convex_cut.h"
#include "stock/turning/insert_sweep.h"

namespace kerf::turning {

/// Over pieces that a straight way removes. All mm.
///
///     ------------.               Seen along the way, the tool's leading edges lie one beside the
///      material   |  \            other. A piece of material meets those beside which it lies, so
///     ............|   > tool      its width across the way says which edges cut it, and how deep
///     -------.....|  /            the tool was in it.
///             <-- |
struct Engagement {
  bool any = false;
  double across_mm = 0;  ///< greatest width of one piece across the way
  double depth_mm = 0;   ///< greatest of the lesser of a piece's width and its length along the way
  double first = 0;      ///< share of the way after which the tool first meets one
  std::array<double, kInsertSides> side_mm{};  ///< greatest width met by edges of that side

  void extend(const Engagement& other);
};

/// Pieces thinner than ConvexCut::kFilm on the average do not count: rounding makes such.
/// `way` is the tool's, to - from, in units.
Engagement engagement_of(const ConvexCut& cut, const GridPart::Lead& lead, const Point& way);

}  // namespace kerf::turning
