// twin/compare/design_fit.h - where a design lies best on the workpiece that was cut.
#pragma once

#include <optional>
#include <vector>

#include "base/geometry.h"
#include "stock/stock_model.h"
#include "twin/compare/design_file.h"
#include "twin/compare/design_part.h"

namespace kerf {

/// A point of the workpiece's surface, with the way out of the material.
struct FitPoint {
  Vec3 at_mm{0};
  Vec3 normal{0, 0, 1};
  double doubt_mm = 0;  ///< so far off it may be where all is right: walls go by cells
};

/// Points spread evenly over what has been cut (of a model that keeps cut ids; of all there is, if
/// nothing was), `count` of them.
std::vector<FitPoint> fit_points(const StockModel& stock, std::size_t count);

struct DesignFit {
  DesignPlacement placement;
  double residue_mm = 0;  ///< root of the mean square, over the points that count
  double share = 0;       ///< of the points, those that count
};

/// Moves and turns the design, from `start` on, so that the points lie on its surface: each is
/// drawn to the plane of the nearest triangle that faces as it does (point-to-plane ICP, Y. Chen,
/// G. Medioni, "Object modelling by registration of multiple range images", 1992). Points that are
/// more than three times as far off as the middle one, and than they may be, do not count: what is
/// left over or cut too deep does not pull. What the surface does not say (a part that turns, about
/// its axis) stays as it was. Finds the best place near the start (some mm, some ten degrees), not
/// any. `design`: as it is in its file. None: fewer than six points count.
std::optional<DesignFit> fit_design(const DesignPart& design, const std::vector<FitPoint>& points,
                                    const DesignPlacement& start);

/// From `start`, and from where the box of the design lies in the blank's: in its middle with the
/// tops level, and corner on corner. Where none of these fits well (0.02 mm), also from all quarter
/// turns that go into the blank. The best of all; of equal ones that which is turned least.
std::optional<DesignFit> fit_design_in_blank(const DesignPart& design, const Box& blank_mm,
                                             const std::vector<FitPoint>& points,
                                             const DesignPlacement& start);

}  // namespace kerf
