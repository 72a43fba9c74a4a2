// stock/zmap/part_contact.h - would shank or holder touch the material? Reads only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "stock/stock_model.h"
#include "stock/zmap/tile_grid.h"

namespace kerf {

/// How high the material of each tile reaches: what is far above all of it is told so without a
/// look at cells. Follows the grid's versions; a tile costs a pass over its cells when it is asked
/// about for the first time after a change, which is some hundred ns.
class TileTops {
 public:
  /// Of one tile. Of a grid that cuts are still to come for, it is an upper bound: heights only
  /// fall.
  float top_mm(const TileGrid& grid, std::size_t tile);

 private:
  struct Top {
    float top_mm;
    bool known = false;
    std::uint64_t version = 0;
  };
  std::vector<Top> tops_;
};

/// First contact of a cylinder that stands above a cutter, `part.from_z_mm` above its tip, with
/// material that lies deeper than `tolerance_mm` inside of it. Each cell whose middle the part
/// comes over is looked at in time, in closed form:
///  - before the cutter comes over it, the cell is as high as the grid has it;
///  - from then on it is cut, but for what stands higher than the flutes reach there: that stays
///    until the part meets it;
///  - behind the cutter it is as low as the cutter went at the lowest.
/// Exact for straight moves and for arcs about a vertical axis, up to the middles of cells; other
/// arcs and spirals are taken as chords within the tolerance. `tops` is of this grid. Cost: tiles
/// that are nowhere as high as the part are skipped; some ns for each cell that is as high and
/// within the part's reach.
std::optional<PartContact> find_part_contact(const TileGrid& grid, TileTops& tops,
                                             const Cutter& cutter, const CarriedPart& part,
                                             const CutMove& move, double tolerance_mm);

}  // namespace kerf
