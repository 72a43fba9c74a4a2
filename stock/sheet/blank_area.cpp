#include "stock/sheet/blank_area.h"

#include <algorithm>

namespace kerf {
namespace {

/// Fine enough that few corners of a drawn edge are near any one place.
constexpr int kTilesEachWay = 32;

sheet::Rings outer_rings(const PlaneOutline& outline) {
  sheet::Rings rings = sheet::to_rings(outline.rings);
  std::erase_if(rings, [](const sheet::Ring& ring) { return sheet::twice_area(ring) <= 0; });
  return rings;
}

std::int64_t twice_area_of(const sheet::Rings& rings) {
  std::int64_t area2 = 0;
  for (const sheet::Ring& ring : rings) area2 += sheet::twice_area(ring);
  return area2;
}

}  // namespace

BlankArea::BlankArea(const PlaneOutline& outline)
    : grid_(outer_rings(outline), kTilesEachWay, kTilesEachWay) {}

double BlankArea::share_of(const PlaneOutline& shape) const {
  const sheet::Rings rings = sheet::to_rings(shape.rings);
  const std::int64_t area2 = twice_area_of(rings);
  if (area2 <= 0) return 0;
  sheet::Rect box;
  for (const sheet::Ring& ring : rings) box.extend(sheet::bounds_of(ring));
  const sheet::SheetGrid::TileRange range = grid_.tiles_meeting(box);
  sheet::Rings around;
  const sheet::Rect& bounds = grid_.bounds();
  bool is_inside = bounds.holds({box.min_x, box.min_y}) && bounds.holds({box.max_x, box.max_y});
  for (int row = range.first_row; row <= range.last_row; ++row) {
    for (int column = range.first_column; column <= range.last_column; ++column) {
      const std::size_t index = grid_.index_of(column, row);
      const sheet::Tile& tile = grid_.tile(index);
      is_inside = is_inside && tile.area2 == sheet::twice_area_of(grid_.tile_rect(index));
      for (const sheet::TileRingPointer& ring : tile.rings) {
        if (ring->box.meets(box)) around.push_back(ring->points);
      }
    }
  }
  if (is_inside) return 1;
  if (around.empty()) return 0;
  ClipperLib::Clipper clipper;
  clipper.AddPaths(rings, ClipperLib::ptSubject, true);
  clipper.AddPaths(around, ClipperLib::ptClip, true);
  sheet::Rings common;
  clipper.Execute(ClipperLib::ctIntersection, common, ClipperLib::pftNonZero,
                  ClipperLib::pftNonZero);
  return std::clamp(static_cast<double>(twice_area_of(common)) / static_cast<double>(area2), 0.0,
                    1.0);
}

}  // namespace kerf
