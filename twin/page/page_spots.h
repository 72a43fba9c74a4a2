// twin/page/page_spots.h - places of a program that a page leads to: a click shows the line, and
// in the 3D view the place.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "base/geometry.h"
#include "interp_bridge/motion.h"

namespace kerf {

struct PageSpot {
  SourceRef source;
  std::optional<Vec3> place_mm;
};

/// In the order of their numbers in the page's data ("spots").
class PageSpots {
 public:
  /// A button that leads there, as HTML; empty without a line.
  std::string link(const SourceRef& source, const std::optional<Vec3>& place_mm);

  const std::vector<PageSpot>& all() const { return spots_; }

 private:
  std::vector<PageSpot> spots_;
};

}  // namespace kerf
