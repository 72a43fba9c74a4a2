// stock/sheet/blank_area.h - how much of a punch comes down on the sheet, and how much beside it.
#pragma once

#include "stock/plane/outline.h"
#include "stock/sheet/sheet_grid.h"

namespace kerf {

/// What lies within the outer edges of a sheet. Its holes are no edges: what is cut out of it, or
/// was when it was bought, is around a punch that comes down there.
///
///      +---------------------+
///      |      .---.          |          share_of() a shape at a: 1 (also over the hole)
///      |     ( hole )     .--+--.                           at b: about a half
///      |   a  '---'       | b|  |                           at c: 0
///      +------------------'--+--'   c
class BlankArea {
 public:
  /// `outline`: as Sheet::outline() has it.
  explicit BlankArea(const PlaneOutline& outline);

  /// What part of the shape's area lies within: 0 .. 1. `shape`: outer rings counter-clockwise,
  /// holes clockwise (footprint_at()); 0 if it has no area. O(corners of the shape) well inside;
  /// near the edge those of the edge nearby as well, n log n.
  double share_of(const PlaneOutline& shape) const;

 private:
  sheet::SheetGrid grid_;
};

}  // namespace kerf
